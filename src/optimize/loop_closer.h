// Global consistency: keeps keyframes, finds loops, optimises the pose graph and makes the map that
// belongs to the corrected poses. Also relocalises a lost camera. Reads frames as they are tracked
// and fused. Never modifies the map in use, but hands out a corrected one when it is ready.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "optimize/jump_detector.h"
#include "optimize/map_corrector.h"
#include "optimize/part_joiner.h"
#include "optimize/scan_calibration.h"

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

    // State needed to continue in another process.
    struct Memory {
        ScanGraph::Memory graph;
        std::vector<StoredFrame> frames;  // by increasing ordinal
        std::int64_t next_ordinal = 0;
    };

    using Labels = MapCorrector::Labels;
    using MakePager = MapCorrector::MakePager;
    LoopCloser(const LoopConfig& config, const FieldSettings& settings, double depth_units_per_m,
               std::optional<Labels> labels = std::nullopt, MakePager make_pager = {});
    LoopCloser(const LoopCloser&) = delete;
    LoopCloser& operator=(const LoopCloser&) = delete;

    // Before the first Add. Restarts a corrected map that was in progress.
    void Resume(Memory memory);

    // Call for every tracked frame, after its fusion if it was fused. Returns a message for the
    // user, usually empty.
    std::string Add(const Frame& frame, const PreparedFrame& prepared, const TrackResult& track,
                    const Integrator::View& view, bool fused);
    // Adds the detections of an earlier frame, at any time. `ignored`: see FrameStore.
    void AddDetections(std::int64_t frame_index, std::vector<Detection> detections,
                       const ClassSet& ignored) {
        store_.AddDetections(frame_index, std::move(detections), ignored);
    }
    // Corrected maps that are begun from now on have labels.
    void EnableLabels(Labels labels) { corrector_.EnableLabels(std::move(labels)); }
    // Off: frames are kept, but no loop is closed and no corrected map is made before the end.
    void SetSeeking(bool on) { seeking_ = on; }
    // For a tracked frame of which only the pose is kept.
    void Pass(double stamp_s, const Eigen::Isometry3d& T_map_camera, bool fused);
    // Where the camera of this frame, taken at `stamp_s`, is. Empty if the place is unknown or
    // ambiguous. A view that parts of the scan have in common may join them. `note`: message for
    // the user. `T_map_expected`: looks only in its part of the scan.
    std::optional<FoundCamera> Relocalise(
        double stamp_s, const PreparedFrame& frame, std::string& note,
        const std::optional<Eigen::Isometry3d>& T_map_expected = std::nullopt);
    // Call before Add or Pass of the first frame that was tracked where Relocalise found the
    // camera. The next keyframe is linked to the one that was found: nothing is known of the motion
    // since the last.
    void LinkNextTo(int keyframe);

    // Works on the corrected map: fuses at most this many stored frames into it.
    std::optional<Correction> Step(int frames);
    // True if Step has work to do.
    bool HasWork() const { return seeking_ && (corrector_.busy() || graph_.moved()); }
    // True if a corrected map is due and the one in use can be moved: see Move. Without Move, Step
    // fuses all frames again.
    bool WantsMap() const { return HasWork() && corrector_.WantsMap(); }
    // The same, or the map is being moved.
    bool MovesMap() const { return WantsMap() || corrector_.moves_copy(); }
    // `copy`: of the map in use, with all frames and corrections so far. See MapCorrector. Asks
    // again if the camera turns out to be elsewhere before the copy is moved.
    void Move(std::unique_ptr<BlockMap> copy) {
        if (!corrector_.busy()) fused_since_copy_ = false;
        corrector_.Move(std::move(copy));
    }
    // Returns once why the map is no longer corrected, or why frames are missing from it; usually
    // empty.
    std::string TakeError();
    // At the end of a run: makes all remaining corrections, and refines the calibration if
    // configured. `note`: message for the user about the calibration. `in_use`: the map with all
    // frames and corrections so far, which is then moved as far as possible. If null, and with a
    // pager or labels that move far, it is fused again. `free_map`: if given, it is called before
    // all frames are fused again if nothing can stop that: the map in use is then needed no more.
    std::optional<Correction> Finish(std::string& note, const BlockMap* in_use = nullptr,
                                     const std::function<void()>& free_map = {});
    // Outside a run: optimises with every overlap that can be found, and makes the map again from
    // all stored frames of the largest part.
    Result<Correction> MakeAgain();

    // Corrected poses of all frames, in order; after Finish and MakeAgain, of the largest part
    // only.
    std::vector<StampedPose> Path() const { return graph_.Path(); }
    const Keyframes& keyframes() const { return graph_.keyframes(); }
    const ScanGraph& graph() const { return graph_; }
    const FrameStore& store() const { return store_; }
    // Set after Finish if the calibration was refined and the scan allowed an estimate.
    const std::optional<CalibrationReport>& calibration() const { return calibration_; }

  private:
    void AddPlaces();
    void MakeMissingViews();
    std::optional<Eigen::Isometry3d> Follow(double stamp_s, const Eigen::Isometry3d& T_map_camera,
                                            bool fused);
    void Interrupt();
    void AddKeyframe(const Frame& frame, const PreparedFrame& prepared, const TrackResult& track,
                     const FrameMotion& motion, const Eigen::Isometry3d& T_map_expected,
                     bool doubtful);
    void DiscardCopy();
    bool MoveAlike(int a, int b) const;
    std::optional<int> LinkedTo(const Eigen::Isometry3d& T_map_camera) const;
    std::string SeekLoop(const Keyframe& fresh, const PreparedFrame& prepared,
                         const FrameMotion& motion);
    std::string CloseLoop(const Keyframe& old, const Keyframe& fresh, const FieldVerdict& verdict);
    std::string SeekDrift();
    std::string SeekOtherParts(const Keyframe& fresh, const PreparedFrame& prepared);
    // The map in use is about to be replaced, or just was: it may hold places twice.
    bool outdated() const { return corrector_.busy() || swapped_; }
    std::optional<Correction> StepCorrection(int frames);
    std::optional<Correction> MakeAll(const std::function<void()>& free_map = {});
    std::optional<Correction> FuseAll(const std::function<void()>& free_map = {});
    std::optional<Correction> CatchUp(const BlockMap* in_use,
                                      const std::function<void()>& free_map = {});
    bool Calibrate(std::string& note);
    bool LeavePartsOut(std::string& note);

    LoopConfig config_;
    FieldSettings settings_;
    FrameStore store_;
    ScanGraph graph_;
    PlaceFinder places_;
    PartJoiner joiner_;
    MapCorrector corrector_;
    JumpDetector jumps_;
    std::optional<int> link_;  // keyframe to which the next one is linked; else to the newest
    // Where a lost camera was seen last, if it has not been tracked elsewhere since, and the frame
    // that showed it.
    std::optional<int> seen_at_;
    double seen_at_s_ = 0;
    std::optional<CalibrationReport> calibration_;
    bool seeking_ = true;
    bool fused_since_copy_ = false;  // of the map that is moved
    bool swapped_ = false;           // the map was replaced after the last keyframe
};

}  // namespace tessera
