// The first half of a frame's life: prepare it, find where the camera was, judge that. Reads the
// map, never writes it.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "core/frame.h"
#include "mapping/integrator.h"
#include "mapping/prepared_frame.h"
#include "mapping/ray_caster.h"
#include "system/device.h"
#include "system/motion_model.h"
#include "system/pipeline_config.h"
#include "system/viewer_settings.h"
#include "tracking/image_aligner.h"
#include "tracking/moving_detector.h"

namespace tessera {

// What became of one frame.
struct FrameReport {
    std::int64_t index = 0;
    double stamp_s = 0;
    TrackingMethod method = TrackingMethod::kSdf;
    TrackResult track;   // status good, with the given pose, when poses are given
    bool first = false;  // the frame that started the map
    bool fused = false;
    double valid_depth_fraction = 0;  // of the image, without what was expected to move
    std::string warning;  // what a person should know of this frame, in words; mostly empty
    Integrator::Report fusion;
    std::shared_ptr<const MovingMask> moving;  // null: nothing moves
    double prepare_ms = 0, track_ms = 0, moving_ms = 0;

    bool tracked() const { return track.status != TrackStatus::kLost; }
};

// A frame between the two halves of its life, with all that fusion needs.
struct TrackedFrame {
    PreparedFrame prepared;
    FrameReport report;
    Integrator::View view;
    bool to_fuse = false;
    // TrackingStage::SaveState after this frame, while a scan is written.
    std::vector<std::uint8_t> tracking_state;
};

// Owner thread only.
class TrackingStage {
  public:
    // `device` outlives the stage; null: all on the processor.
    TrackingStage(const PipelineConfig& config, const PinholeCamera& camera,
                  Device* device = nullptr);

    // Into `tracked`, whose storage is used again. With a given pose the frame is not tracked. The
    // world is the first frame's camera unless its pose is given; that frame is always to be fused,
    // and must be in `map` when the next one comes. Nobody may write `map` meanwhile.
    void Track(const Frame& frame, const BlockMap& map,
               const std::optional<Eigen::Isometry3d>& given, TrackedFrame& tracked);

    // What a detector says may move in the frame that comes next, or in an earlier one tracked to
    // T_world_camera: not to be fused.
    void GuideMoving(const MovingHint& hint,
                     const std::optional<Eigen::Isometry3d>& T_world_camera);

    // Tracks the frame given last once more, from another place; only if it then fits well is its
    // result taken, and true returned.
    bool TrackFrom(const Frame& frame, const BlockMap& map, const Eigen::Isometry3d& T_world_camera,
                   TrackedFrame& tracked);
    // The pose of the frame given last is not to be believed: it is lost.
    void Disbelieve(const std::string& reason, TrackedFrame& tracked);
    // The camera was lost, and was found to have been here at that time.
    void Relocate(const StampedPose& pose);
    // The map was moved, the camera with it.
    void Move(const Eigen::Isometry3d& T_new_old);

    // Whether Track reads the voxels of `map`, not only the device's.
    bool reads_map() const { return trackers_.reads_map(); }

    // From the next frame on; pose, velocity, brightness and map stay.
    void Select(TrackingMethod method) { trackers_.Select(method); }
    // With a device: frames' images are wanted on the processor, too.
    void BringImages() { bring_images_ = true; }
    // Off: frames are tracked, but are not to be fused; the first always is.
    void SetFusing(bool on) { fusing_ = on; }
    void Apply(const ViewerSettings& settings);
    // Forgets the camera's way, not the settings: the next frame is a new world's first.
    void Reset();

    // All that the next frame's pose depends on besides the map and the settings: where the camera
    // was and how it moved, what colour has taught, the last frame's reduced images. False: the
    // bytes are no such state, and the camera's way is forgotten.
    void SaveState(StateWriter& state) const;
    bool LoadState(StateReader& state);
    // As if the last frame had been tracked there, and nothing more were known of the way.
    void StartAt(const StampedPose& last);

  private:
    TrackResult TrackFrame(const Frame& frame, const PreparedFrame& prepared, const BlockMap& map);
    std::shared_ptr<const MovingMask> ExpectMoving(double stamp_s) const;
    void LeaveOutMoving(const Frame& frame, const BlockMap& map, bool hidden,
                        TrackedFrame& tracked);
    void PrepareOnDevice(const Frame& frame, const MovingMask* moving, PreparedFrame& prepared);
    double NearestOfWeight(const PreparedFrame& prepared) const;
    FrameMotion ShutterOf(const Frame& frame) const;

    PipelineConfig config_;
    PinholeCamera camera_;
    MotionModel motion_, motion_before_;  // after and before the last frame
    ImageAligner aligner_;
    MovingDetector moving_;
    RayCaster caster_;
    Trackers trackers_;
    Device* device_;
    bool fusing_ = true, bring_images_ = false;
};

}  // namespace tessera
