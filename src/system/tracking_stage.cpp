#include "system/tracking_stage.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "core/quantile.h"
#include "core/stopwatch.h"

namespace tessera {
namespace {

Integrator::View FusionView(const TrackResult& track, const PreparedFrame& prepared) {
    return {.T_world_camera = track.T_world_camera,
            .motion = track.motion,
            .gain = static_cast<float>(track.gain),
            .offset = static_cast<float>(track.offset),
            .colour_weight = prepared.has_colour ? 1.0f : 0.0f};
}

}  // namespace

TrackingStage::TrackingStage(const PipelineConfig& config, const PinholeCamera& camera,
                             Backend* device)
    : config_(config),
      planned_depth_m_(config.frame.max_depth_m),
      camera_(camera),
      motion_(config.motion),
      motion_before_(config.motion),
      aligner_(config.prealign, camera),
      usual_fit_(config.trackers.judge.doubt_misfit, config.trackers.judge.doubt_known_fraction),
      moving_(config.moving, camera),
      backend_(device),
      trackers_(config.trackers, camera, *backend_) {}

void TrackingStage::Track(const Frame& frame, const BlockMap& map,
                          const std::optional<Eigen::Isometry3d>& given, TrackedFrame& tracked) {
    PreparedFrame& prepared = tracked.prepared;
    FrameReport& report = tracked.report;
    report = {};
    report.index = frame.index;
    report.stamp_s = frame.stamp_s;
    report.method = trackers_.method();
    report.method_choices = method_choices_;

    // 1. Gate the depth and prepare the colour. What moved in earlier frames must not influence
    // the pose, nor must the colours of a camera that hangs.
    Stopwatch watch;
    const std::shared_ptr<const MovingMask> expected =
        given ? nullptr : ExpectMoving(frame.stamp_s);
    backend_->Prepare(frame, config_.frame, expected.get(), keep_images_, prepared);
    prepared.limit_m = config_.frame.max_depth_m;
    if (config_.trackers.photometric.doubt_contrast > 0 && frozen_colour_.Repeats(frame))
        ForgetColour(prepared);
    report.prepare_ms = watch.LapMs();
    report.valid_depth_fraction = static_cast<double>(prepared.valid_depth_pixels) /
                                  static_cast<double>(frame.depth_m.size());

    // 2. Estimate the camera pose.
    EstimatePose(frame, map, given, tracked);
    report.track_ms = watch.LapMs();
    report.rasterise_ms = trackers_.TakeRasterise_ms();

    // 3. Mask what moves, so that it is not fused.
    MaskMoving(frame, map, expected != nullptr, tracked);
    report.moving_ms = watch.LapMs();

    // 4. Decide whether to fuse.
    tracked.to_fuse = report.track.status == TrackStatus::kGood && Fuses(report.first);
    tracked.view = FusionView(report.track, prepared);
}

void TrackingStage::EstimatePose(const Frame& frame, const BlockMap& map,
                                 const std::optional<Eigen::Isometry3d>& given,
                                 TrackedFrame& tracked) {
    PreparedFrame& prepared = tracked.prepared;
    FrameReport& report = tracked.report;
    motion_before_ = motion_;
    report.first = !motion_.last().has_value();
    if (prepared.valid_depth_pixels == 0) {
        report.track.reason = prepared.measured_pixels > 0
                                  ? "0 depth pixels in range: is depth_scale right?"
                                  : "0 depth pixels in the image";
    } else if (prepared.coherent_fraction < config_.frame.min_coherent_fraction) {
        report.track.reason =
            fmt::format("the depth is noise: only {:.0f} % of neighbouring pixels agree",
                        100 * prepared.coherent_fraction);
    } else if (given) {
        report.track.T_world_camera = *given;
        report.track.status = TrackStatus::kGood;
    } else if (report.first) {
        report.track.status = TrackStatus::kGood;  // the first camera defines the world frame
        report.track.T_world_camera = T_world_start_;
        aligner_.Align(prepared, Eigen::Isometry3d::Identity());
    } else {
        report.track = TrackFrame(frame, map, prepared);
        report.warning = trackers_.TakeNote();
        if (!report.track.T_world_camera.matrix().allFinite()) {
            report.track = {};
            report.track.reason = "the pose is not a number";
        }
    }
    // An image that is shown again is as wrong as it was.
    if (!frozen_colour_.repeats()) colour_wrong_ = !frame.colour.empty() && !prepared.has_colour;
    report.track.colour_rejected = colour_wrong_ || frozen_colour_.hangs();
    report.first = report.first && report.tracked();
    if (report.tracked())
        motion_.Add({frame.stamp_s, report.track.T_world_camera},
                    {.degenerate = report.track.degenerate,
                     .poor = report.track.status == TrackStatus::kPoor,
                     .uncertainty_m = report.track.uncertainty_m});
    else
        motion_.AddLost();
}

bool TrackingStage::TrackFrom(const Frame& frame, const BlockMap& map,
                              const Eigen::Isometry3d& T_world_camera, TrackedFrame& tracked) {
    Stopwatch watch;
    TrackResult track = trackers_.Track({.frame = tracked.prepared,
                                         .map = map,
                                         .T_world_camera_starts = {T_world_camera},
                                         .T_world_camera_last = T_world_camera,
                                         .since_last_s = 0,
                                         .motion = FrameMotionOf(frame)});
    tracked.report.track_ms += watch.LapMs();
    tracked.report.rasterise_ms += trackers_.TakeRasterise_ms();
    if (track.status != TrackStatus::kGood || track.degenerate || !usual_fit_.Matches(track))
        return false;
    track.colour_rejected = tracked.report.track.colour_rejected;
    tracked.report.track = std::move(track);
    motion_.Clear();
    moving_.Clear();
    motion_.Add({frame.stamp_s, tracked.report.track.T_world_camera}, {});
    aligner_.KeepNewest(true);
    tracked.to_fuse = Fuses(false);
    tracked.view = FusionView(tracked.report.track, tracked.prepared);
    return true;
}

void TrackingStage::RejectPose(const std::string& reason, TrackedFrame& tracked) {
    motion_ = motion_before_;
    motion_.AddLost();
    aligner_.KeepNewest(false);
    moving_.Clear();
    tracked.report.track.status = TrackStatus::kLost;
    tracked.report.track.reason = reason;
    tracked.to_fuse = false;
}

void TrackingStage::Relocate(const StampedPose& pose) {
    motion_.Clear();
    moving_.Clear();
    aligner_.KeepNewest(true);  // closer to that pose than the last frame before the loss
    motion_.Add(pose, {});
}

void TrackingStage::Move(const Eigen::Isometry3d& T_new_old) {
    motion_.Move(T_new_old);
    moving_.Move(T_new_old);
}

// A colour image that contradicts the map (of a camera that is dark or dazzled) would pull the pose
// away: the frame is then tracked again by its depth alone.
TrackResult TrackingStage::TrackFrame(const Frame& frame, const BlockMap& map,
                                      PreparedFrame& prepared) {
    TrackResult track = TrackOnce(frame, map, prepared);
    if (track.colour_rejected) {
        ForgetColour(prepared);
        aligner_.KeepNewest(false);  // it is replaced
        track = TrackOnce(frame, map, prepared);
        track.colour_rejected = true;
    }
    DemandUsualFit(frame.stamp_s, track);
    aligner_.KeepNewest(track.status != TrackStatus::kLost);  // same decision as for motion_
    return track;
}

TrackResult TrackingStage::TrackOnce(const Frame& frame, const BlockMap& map,
                                     const PreparedFrame& prepared) {
    const Eigen::Isometry3d& T_world_last = motion_.last()->T_world_camera;
    const Eigen::Isometry3d T_world_expected = motion_.Predict(frame.stamp_s);
    const Eigen::Isometry3d T_world_aligned =
        T_world_last * aligner_.Align(prepared, T_world_last.inverse() * T_world_expected);
    return trackers_.Track(
        {.frame = prepared,
         .map = map,
         .T_world_camera_starts = {T_world_expected, T_world_aligned},
         .T_world_camera_last = T_world_last,
         // With a doubtful last pose, a large step does not count as a jump.
         .since_last_s = motion_.doubt().poor ? 0 : motion_.SinceLast(frame.stamp_s),
         .frames_since_last = 1 + motion_.lost_frames(),
         .place_known = PlaceKnown(frame.stamp_s),
         .motion = FrameMotionOf(frame),
         .nearest_m = MinWeightDepth(prepared)});
}

// The frame follows a tracked one without a gap in time, and soon enough for its pose to be
// predicted.
bool TrackingStage::PlaceKnown(double stamp_s) const {
    const double since_last_s = motion_.SinceLast(stamp_s);
    return since_last_s > 0 && motion_.lost_frames() == 0 && usual_fit_.Predicted(since_last_s);
}

// Where the camera is not known even roughly, its pose is trusted only if the frame fits well.
// After a poor frame it is about known, and the frame keeps its pose.
void TrackingStage::DemandUsualFit(double stamp_s, TrackResult& track) {
    if (track.unexpected && usual_fit_.Confirms(track)) {
        track.status = TrackStatus::kGood;
        track.reason.clear();
    }
    if (track.status == TrackStatus::kLost) return;
    const bool known = PlaceKnown(stamp_s);
    // A pose that is poor for its prediction alone has nothing that speaks for it where predictions
    // are usually worth nothing, nor has one that leaves a motion open after a gap in time.
    const double since_last_s = motion_.SinceLast(stamp_s);
    const bool gap = since_last_s == 0 && motion_.lost_frames() == 0;
    if (track.status == TrackStatus::kPoor &&
        (usual_fit_.Predicted(since_last_s) ? gap && track.degenerate
                                            : track.unexpected || track.degenerate))
        track.status = TrackStatus::kLost;
    if ((!known || motion_.doubt().poor || track.colour_rejected) && !usual_fit_.Matches(track)) {
        if (track.status == TrackStatus::kGood) track.reason = usual_fit_.Reason(track);
        track.status = known ? TrackStatus::kPoor : TrackStatus::kLost;
    }
    // Neither colour nor depth of such a frame can be trusted: its pose is no start for the next.
    if (track.colour_rejected && track.status == TrackStatus::kPoor)
        track.status = TrackStatus::kLost;
    if (track.status == TrackStatus::kGood) usual_fit_.Add(track);
}

// A nearby person who starts to walk must not outweigh the room behind. So points nearer than the
// median depth get no extra weight, unless the pose is so uncertain that it needs them.
double TrackingStage::MinWeightDepth(const PreparedFrame& prepared) const {
    if (motion_.doubt().uncertainty_m > config_.trackers.even_within_m) return kMinWeightDepth_m;
    return std::max<double>(kMinWeightDepth_m, MedianDepth(prepared.reduced.front().depth_m));
}

FrameMotion TrackingStage::FrameMotionOf(const Frame& frame) const {
    FrameMotion motion;
    motion.colour_delay_s =
        config_.shutter.colour_delay ? frame.colour_stamp_s - frame.stamp_s : 0.0;
    motion.depth_readout_s = config_.shutter.depth_readout_s;
    motion.colour_readout_s = config_.shutter.colour_readout_s;
    return motion;
}

}  // namespace tessera
