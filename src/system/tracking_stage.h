// The first half of the pipeline: prepares a frame, estimates the camera pose and judges it. Reads
// the map, never writes it.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "core/frame.h"
#include "mapping/integrator.h"
#include "mapping/prepared_frame.h"
#include "system/backend.h"
#include "system/motion_model.h"
#include "system/pipeline_config.h"
#include "system/viewer_settings.h"
#include "tracking/frozen_colour.h"
#include "tracking/image_aligner.h"
#include "tracking/moving_detector.h"
#include "tracking/usual_fit.h"

namespace tessera {

// The result of one frame.
struct FrameReport {
    std::int64_t index = 0;
    double stamp_s = 0;
    TrackingMethod method = TrackingMethod::kSdf;
    int method_choices = 0;  // of the newest ViewerSettings that this frame heeds
    TrackResult track;       // with given poses: status good and the given pose
    // The frame that started the map, or, if begins_part, a new part of the scan in the same map.
    bool first = false, begins_part = false;
    bool fused = false;
    double valid_depth_fraction = 0;  // of the image, without what was expected to move
    std::string warning;              // for the user; usually empty
    Integrator::Report fusion;
    std::shared_ptr<const MovingMask> moving;  // null: nothing moves
    double prepare_ms = 0, track_ms = 0, moving_ms = 0;
    double rasterise_ms = 0;  // part of track_ms: see Trackers::TakeRasterise_ms

    bool tracked() const { return track.status != TrackStatus::kLost; }
};

// A frame between tracking and mapping, with all that fusion needs.
struct TrackedFrame {
    PreparedFrame prepared;
    FrameReport report;
    Integrator::View view;
    bool to_fuse = false;
    // The keyframe where the camera was found, if this is the first frame tracked since.
    std::optional<int> found_at;
    // TrackingStage::SaveState after this frame. Filled while a scan is written.
    std::vector<std::uint8_t> tracking_state;
};

// Owner thread only.
class TrackingStage {
  public:
    // `device` outlives the stage. Null: everything runs on the CPU.
    TrackingStage(const PipelineConfig& config, const PinholeCamera& camera,
                  Backend* device = nullptr);

    // Writes to `tracked` and reuses its storage. With a given pose, the frame is not tracked. The
    // world frame is the first frame's camera unless its pose is given. The first frame is always
    // fused and must be in `map` before the next call. Nothing may write to `map` during the call.
    void Track(const Frame& frame, const BlockMap& map,
               const std::optional<Eigen::Isometry3d>& given, TrackedFrame& tracked);

    // What a detector reports as movable, in the next frame or in an earlier one tracked to
    // T_world_camera. It is not fused.
    void HintMoving(const MovingHint& hint, const std::optional<Eigen::Isometry3d>& T_world_camera);

    // Tracks the last frame again from another start pose. Takes the result and returns true only
    // if it fits well.
    bool TrackFrom(const Frame& frame, const BlockMap& map, const Eigen::Isometry3d& T_world_camera,
                   TrackedFrame& tracked);
    // Rejects the pose of the last frame and marks the frame as lost.
    void RejectPose(const std::string& reason, TrackedFrame& tracked);
    // The lost camera was relocalised at this pose and time.
    void Relocate(const StampedPose& pose);
    // The map was moved, and the camera with it.
    void Move(const Eigen::Isometry3d& T_new_old);

    // Whether Track reads the voxels of `map` on the CPU.
    bool reads_map() const { return trackers_.reads_map(); }
    // The last tracked pose. Nothing before the first.
    const std::optional<StampedPose>& last() const { return motion_.last(); }

    // Takes effect at the next frame. Pose, velocity, brightness and map are kept.
    void Select(TrackingMethod method) { trackers_.Select(method); }
    // With a device: also copy each frame's images to the CPU.
    void KeepImages() { keep_images_ = true; }
    // Off: frames are tracked but not fused. The first is always fused.
    void SetFusing(bool on) { fusing_ = on; }
    bool fusing() const { return fusing_; }
    // From now on nothing is fused, whatever the settings.
    void OnlyTrack() { only_track_ = true; }
    // Returns a message for the user, usually empty.
    std::string Apply(const ViewerSettings& settings);
    // Forgets the trajectory but keeps the settings. The next frame starts a new world.
    void Reset();
    // The next frame starts a new part of the map: its camera is there. How well frames usually fit
    // is not forgotten.
    void BeginPart(const Eigen::Isometry3d& T_world_start);

    // All state that the next pose depends on, besides the map and the settings: the last pose and
    // the motion, what was learnt from colour, and the last frame's reduced images. LoadState
    // returns false if the state is invalid; the trajectory is then forgotten.
    void SaveState(StateWriter& state) const;
    bool LoadState(StateReader& state);
    // As if the last frame had been tracked at this pose, with no other history.
    void StartAt(const StampedPose& last);

  private:
    void EstimatePose(const Frame& frame, const BlockMap& map,
                      const std::optional<Eigen::Isometry3d>& given, TrackedFrame& tracked);
    TrackResult TrackFrame(const Frame& frame, const BlockMap& map, PreparedFrame& prepared);
    TrackResult TrackOnce(const Frame& frame, const BlockMap& map, const PreparedFrame& prepared);
    std::shared_ptr<const MovingMask> ExpectMoving(double stamp_s) const;
    void MaskMoving(const Frame& frame, const BlockMap& map, bool hidden, TrackedFrame& tracked);
    bool PlaceKnown(double stamp_s) const;
    void DemandUsualFit(double stamp_s, TrackResult& track);
    double MinWeightDepth(const PreparedFrame& prepared) const;
    FrameMotion FrameMotionOf(const Frame& frame) const;
    bool Fuses(bool first) const { return !only_track_ && (fusing_ || first); }

    PipelineConfig config_;
    // As configured. With a memory limit, what stays in memory is planned for this depth.
    double planned_depth_m_;
    bool told_depth_ = false;
    PinholeCamera camera_;
    Eigen::Isometry3d T_world_start_ = Eigen::Isometry3d::Identity();  // of the first frame
    MotionModel motion_, motion_before_;  // after and before the last frame
    ImageAligner aligner_;
    // Not part of the saved state: they are soon known again.
    UsualFit usual_fit_;
    FrozenColour frozen_colour_;
    bool colour_wrong_ = false;  // of the last image that was no repetition
    MovingDetector moving_;
    BackendOf backend_;
    Trackers trackers_;
    int method_choices_ = 0;  // of the newest settings
    bool fusing_ = true, only_track_ = false, keep_images_ = false;
};

}  // namespace tessera
