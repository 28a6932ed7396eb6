// Global consistency: keeps keyframes, finds loops, optimises the pose graph and rebuilds the map
// from the corrected poses. Also relocalises a lost camera. Reads frames as they are tracked and
// fused. Never modifies the map in use, but hands out a corrected one when it is ready.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "optimize/calibration_report.h"
#include "optimize/calibration_view.h"
#include "optimize/frame_average.h"
#include "optimize/jump_detector.h"
#include "optimize/keyframes.h"
#include "optimize/loop_verifier.h"
#include "optimize/map_rebuild.h"
#include "optimize/overlaps.h"
#include "optimize/place_index.h"
#include "optimize/pose_graph.h"
#include "optimize/scan_parts.h"

namespace tessera {

// Owner thread only. The result does not depend on the number of threads.
class LoopCloser {
  public:
    // Replaces the current map. Move camera poses in it likewise: T_new = T_new_old * T_old.
    struct Correction {
        std::unique_ptr<BlockMap> map;
        // Of the new map; null without labels, or if the map has those of the one in use.
        std::unique_ptr<LabelMapper> labels;
        // The pager made for the new map, null without paging; it holds all of the map.
        std::unique_ptr<MapPager> pager;
        Eigen::Isometry3d T_new_old = Eigen::Isometry3d::Identity();
        // The map was moved: what has changed since in the one given to Move is missing.
        bool moved = false;
    };

    struct PathPose {  // a tracked frame
        double stamp_s = 0;
        int keyframe = 0;
        Eigen::Isometry3d T_keyframe_camera;
        bool fused = true;
    };
    // State needed to continue in another process.
    struct Memory {
        std::vector<Keyframe> keyframes;
        std::vector<PoseEdge> edges;
        std::vector<PathPose> passages;
        std::vector<StoredFrame> frames;  // by increasing ordinal
        std::int64_t next_ordinal = 0;
        int loops = 0;
        bool corrected = false;
    };

    // Labelling settings and classes, if objects are labelled.
    struct Labels {
        LabelConfig config;
        LabelClasses classes;
    };

    // `make_pager`: makes a pager that keeps a corrected map within a memory limit. Empty: no
    // paging.
    using MakePager = std::function<Result<std::unique_ptr<MapPager>>()>;
    LoopCloser(const LoopConfig& config, const FieldSettings& settings, double depth_units_per_m,
               std::optional<Labels> labels = std::nullopt, MakePager make_pager = {});

    // Before the first Add. Restarts a corrected map that was in progress.
    void Resume(Memory memory);

    // Call for every tracked frame, after its fusion if it was fused. Returns a message for the
    // user, usually empty.
    std::string Add(const Frame& frame, const PreparedFrame& prepared, const TrackResult& track,
                    const Integrator::View& view, bool fused);
    // Adds the detections of an earlier frame, at any time.
    void AddDetections(std::int64_t frame_index, std::vector<Detection> detections) {
        store_.AddDetections(frame_index, std::move(detections));
    }
    // Corrected maps that are begun from now on have labels.
    void EnableLabels(Labels labels) { labels_ = std::move(labels); }
    // Off: frames are kept, but no loop is closed and no corrected map is made before the end.
    void SetSeeking(bool on) { seeking_ = on; }
    // For a tracked frame of which only the pose is kept.
    void Pass(double stamp_s, const Eigen::Isometry3d& T_map_camera, bool fused);
    // Returns T_map_camera for a frame of a lost camera. Empty if the place is unknown or
    // ambiguous. `note`: message for the user. `T_map_expected`: looks only in its part of the
    // scan.
    std::optional<Eigen::Isometry3d> Relocalise(
        const PreparedFrame& frame, std::string& note,
        const std::optional<Eigen::Isometry3d>& T_map_expected = std::nullopt);
    // Works on the corrected map: fuses at most this many stored frames into it.
    std::optional<Correction> Step(int frames);
    // True if Step has work to do.
    bool HasWork() const { return seeking_ && (rebuild_ != nullptr || moved_); }
    // True if a corrected map is due and the one in use can be moved: see Move. Without Move, Step
    // fuses all frames again.
    bool WantsMap() const;
    // The same, or the map is being moved.
    bool MovesMap() const { return WantsMap() || (rebuild_ && rebuild_->has_copy()); }
    // `copy`: of the map in use, with all frames and corrections so far. If null, or if there is
    // too little memory, all frames are fused again. Blocks about which keyframes disagree are
    // moved as well as possible, and fused again at the end of the run.
    void Move(std::unique_ptr<BlockMap> copy);
    // Returns once why the map is no longer corrected, or why frames are missing from it; usually
    // empty.
    std::string TakeError() { return std::exchange(trouble_, {}); }
    // At the end of a run: makes all remaining corrections, and refines the calibration if
    // configured. `note`: message for the user about the calibration. `in_use`: the map with all
    // frames and corrections so far, which is then moved as far as possible. If null, and with a
    // pager or labels that move far, it is fused again.
    std::optional<Correction> Finish(std::string& note, const BlockMap* in_use = nullptr);

    // Outside a run: optimises with every overlap that can be found, and makes the map again from
    // all stored frames of the largest part.
    Result<Correction> MakeAgain();

    // Corrected poses of all frames, in order; after Finish and MakeAgain, of the largest part
    // only.
    std::vector<StampedPose> Path() const;
    const Keyframes& keyframes() const { return keyframes_; }
    const std::vector<PoseEdge>& edges() const { return edges_; }
    const std::vector<PathPose>& passages() const { return passages_; }
    int loops() const { return loops_; }
    bool corrected() const { return corrected_; }
    const FrameStore& store() const { return store_; }
    // Set after Finish if the calibration was refined and the scan allowed an estimate.
    const std::optional<CalibrationReport>& calibration() const { return calibration_; }

  private:
    // Where a lost camera may be.
    struct Place {
        int keyframe = 0;
        Eigen::Isometry3d T_old_new, T_map_camera;  // of the lost camera's frame
        double explained = 0;                       // FieldVerdict::explained
    };

    void MakeMissingViews();
    using Allows = std::function<bool(int keyframe)>;
    std::vector<Place> PlacesOf(const Features& features, const DenseView& view,
                                const Allows& allows);
    const Place* BestOf(std::vector<Place>& places, const PreparedFrame& frame, std::string& note);
    std::vector<Place> BestOfParts(const Features& features, const DenseView& view,
                                   const PreparedFrame& frame, const Allows& allows,
                                   std::string& note);
    void AddKeyframe(const Frame& frame, const PreparedFrame& prepared, const TrackResult& track,
                     const FrameMotion& motion, const Eigen::Isometry3d& T_map_expected,
                     bool doubtful);
    void Link(int from, int to, const Eigen::Isometry3d& T_map_to, bool doubtful);
    void Follow(const Eigen::Isometry3d& T_map_camera);
    std::optional<int> LatestInPartOf(const Eigen::Isometry3d& T_map_camera) const;
    std::optional<int> LinkedTo(const Eigen::Isometry3d& T_map_camera) const;
    void AddPassage(double stamp_s, const Eigen::Isometry3d& T_map_camera, bool fused);
    std::string SeekOtherParts(const Keyframe& fresh, const PreparedFrame& prepared);
    std::string JoinAt(const std::vector<Place>& places);
    std::string JoinParts(std::span<const int> parts, int a, int b);
    std::ptrdiff_t KeyframesAround(const Eigen::Isometry3d& T_map_camera) const;
    bool LeftOut(int keyframe) const {
        return keyframe < std::ssize(left_out_) && left_out_[static_cast<std::size_t>(keyframe)];
    }
    void LeaveShortPartOut();
    bool PartsMove() const;
    std::unique_ptr<MapRebuild> MoveParts(const BlockMap& in_use,
                                          const std::vector<Eigen::Isometry3d>& graph) const;
    std::string KeepLargestPart();
    Status Store(const Frame& frame, bool keyframe, const Integrator::View& view);
    Status StoreAverage();
    void StoreLatest();
    std::string SeekLoop(const Keyframe& fresh, const PreparedFrame& prepared,
                         const FrameMotion& motion);
    bool ShowTheSame(const Keyframe& old, const Keyframe& fresh,
                     const Eigen::Isometry3d& T_old_new);
    std::string CloseLoop(const Keyframe& old, const Keyframe& fresh, const FieldVerdict& verdict);
    std::string SeekDrift(const Keyframe& fresh);
    std::string ClosedText(const Keyframe& old, const Drift& drift) const;
    // The map in use is about to be replaced, or just was: it may hold places twice.
    bool outdated() const { return rebuild_ || swapped_; }
    std::vector<Eigen::Isometry3d> GraphPoses() const;
    std::vector<Eigen::Isometry3d> MapPoses() const;
    void SetGraphPoses(const std::vector<Eigen::Isometry3d>& T_world_keyframe);
    double MaxDisplacement_m(const std::vector<Eigen::Isometry3d>& T_map_keyframe) const;
    std::optional<CovarianceFactors> Factors() const;
    Status Optimise();
    int FindOverlaps();
    Status OptimiseAgain();
    Status LoadViews(std::vector<CalibrationView>& views);
    Status Calibrate();
    bool MayMove(const BlockMap& in_use) const;
    bool BeginRebuild(double tolerance_m, const BlockMap* in_use = nullptr,
                      MapWarp::Doubtful doubtful = MapWarp::Doubtful::kLeftOut);
    std::optional<Correction> StepRebuild(int frames);
    void StopRebuilding(const Status& why);

    LoopConfig config_;
    FieldSettings settings_;
    std::optional<Labels> labels_;
    MakePager make_pager_;
    Keyframes keyframes_;
    JumpDetector jumps_;
    PlaceIndex index_;
    FrameAverage average_;  // of the latest frames, not stored yet
    int average_keyframe_ = 0;
    FrameStore store_;
    LoopVerifier verifier_;
    OverlapFinder overlaps_;
    std::vector<PoseEdge> edges_;
    std::vector<PathPose> passages_;
    std::vector<CommonPlace> common_;      // of parts that are not joined yet
    std::vector<bool> left_out_;           // keyframes of parts that are left out of path and map
    std::unique_ptr<MapRebuild> rebuild_;  // null if the map is up to date
    std::vector<BlockCoord> doubtful_;     // blocks of the map in use (WarpedMap)
    std::optional<int> relocalised_at_;    // keyframe to which the next one is linked
    int loops_ = 0;
    bool corrected_ = false;  // at least one loop was worth correcting
    std::optional<CalibrationReport> calibration_;
    bool seeking_ = true;
    bool broken_ = false;  // no further map can be built
    std::string trouble_;
    bool moved_ = false;    // keyframes moved since the last Step
    bool swapped_ = false;  // the map was replaced after the last keyframe
};

}  // namespace tessera
