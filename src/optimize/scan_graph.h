// The pose graph of a scan: its keyframes and what is known of how they lie to each other, the path
// of the camera beside them, and the parts that nothing joins yet.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "optimize/loop_config.h"
#include "optimize/overlaps.h"
#include "optimize/scan_parts.h"

namespace tessera {

struct PathPose {  // a tracked frame
    double stamp_s = 0;
    int keyframe = 0;
    Eigen::Isometry3d T_keyframe_camera;
    bool fused = true;
};

// Owner thread only. Keyframe::T_world_camera are the poses of the graph, T_map_camera those with
// which the map in use was made.
class ScanGraph {
  public:
    ScanGraph(const LoopConfig& config, const PinholeCamera& camera);

    // State needed to continue in another process.
    struct Memory {
        std::vector<Keyframe> keyframes;
        std::vector<PoseEdge> edges;
        std::vector<PathPose> passages;
        int loops = 0;
        bool corrected = false;
    };
    // Before anything is added.
    void Resume(Memory memory);

    Keyframes& keyframes() { return keyframes_; }
    const Keyframes& keyframes() const { return keyframes_; }
    OverlapFinder& overlaps() { return overlaps_; }
    const std::vector<PoseEdge>& edges() const { return edges_; }
    const std::vector<PathPose>& passages() const { return passages_; }
    int loops() const { return loops_; }
    // True if at least one loop was worth correcting. Until then tracking's usual drift is
    // believed.
    bool corrected() const { return corrected_; }
    void MarkCorrected() { corrected_ = true; }
    // True if poses have changed since the last ClearMoved.
    bool moved() const { return moved_; }
    void MarkMoved() { moved_ = true; }
    void ClearMoved() { moved_ = false; }

    // ---- The path.
    // A tracked frame, seen from the newest keyframe of its part; if there is none it is left out.
    void AddPassage(double stamp_s, const Eigen::Isometry3d& T_map_camera, bool fused);
    // Constraint from tracking between two keyframes of the map, the second at T_map_to.
    // `doubtful`: tracking may have jumped.
    void Link(int from, int to, const Eigen::Isometry3d& T_map_to, bool doubtful);
    void AddLoop(int from, int to, const Eigen::Isometry3d& T_from_to);
    void CountLoop() { ++loops_; }
    // Corrected poses of all frames, in order, without those of parts that are left out.
    std::vector<StampedPose> Path() const;

    // ---- Poses of all keyframes, by id.
    std::vector<Eigen::Isometry3d> Poses() const;
    std::vector<Eigen::Isometry3d> MapPoses() const;
    void SetPoses(const std::vector<Eigen::Isometry3d>& T_world_keyframe);
    void SetMapPoses(const std::vector<Eigen::Isometry3d>& T_map_keyframe);
    static constexpr double kReach_m = 2.0;
    // Largest displacement of any point within kReach_m of a keyframe, between a map made with
    // these keyframe poses and the graph.
    double Displacement_m(const std::vector<Eigen::Isometry3d>& T_map_keyframe) const;
    // Of the map in use.
    double Displacement_m() const { return Displacement_m(MapPoses()); }

    // ---- The solution. On error the keyframes do not move.
    Status Optimise();
    // Looks for overlaps that the corrected poses show for the first time, newest keyframes first.
    // Returns their number.
    int FindOverlaps();
    // Once a loop was corrected, with the overlaps and the covariances that it shows.
    Status OptimiseAgain();

    // ---- Parts (scan_parts.h).
    std::vector<int> Parts() const { return PartsOf(edges_, keyframes_.all()); }
    std::optional<int> NewestInPartOf(const Eigen::Isometry3d& T_map_camera) const;
    int KeyframesInPartOf(const Eigen::Isometry3d& T_map_camera) const;
    // Two parts were joined, but are not yet in the map.
    bool PartsMove() const { return Displacement_m() > kPartsApart_m / 2; }
    // Joins part b of `parts` (Parts) to part a, as the places say, and optimises.
    Status Join(std::span<const int> parts, int b, const JointPose& joint);
    // By keyframe: whether it is left out of path and map. Empty: none is.
    const std::vector<bool>& left_out() const { return left_out_; }
    bool LeftOut(int keyframe) const {
        return keyframe < std::ssize(left_out_) && left_out_[static_cast<std::size_t>(keyframe)];
    }
    // The part of the last keyframe has ended. It is left out if it has so few frames that a camera
    // found there would soon be lost again.
    void LeaveShortPartOut();
    // At the end: leaves out the parts that were not joined, but for the one with most frames in
    // the map. Its first keyframe's camera is then that of the world. Returns a message for the
    // user, empty if there is only one part.
    std::string KeepLargestPart();

  private:
    std::optional<CovarianceFactors> Factors() const;

    LoopConfig config_;
    Keyframes keyframes_;
    OverlapFinder overlaps_;
    std::vector<PoseEdge> edges_;
    std::vector<PathPose> passages_;
    std::vector<bool> left_out_;
    int loops_ = 0;
    bool corrected_ = false;
    bool moved_ = false;
};

}  // namespace tessera
