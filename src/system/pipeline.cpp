#include "system/pipeline.h"

#include <fmt/format.h>

#include "core/stopwatch.h"

namespace tessera {

void ShutterConfig::Describe(ConfigParameters& p) {
    p.Add("colour_delay", colour_delay,
          "allow for the camera's motion between the depth and the colour image's time stamps");
    p.Add("depth_readout_s", depth_readout_s, {-0.1, 0.1}, "s",
          "time from the depth image's first row to its last: the rolling shutter; 0 is a global one");
    p.Add("colour_readout_s", colour_readout_s, {-0.1, 0.1}, "s", "the same of the colour image");
}

void PipelineConfig::Describe(ConfigParameters& p) {
    p.Section("frame", [&](ConfigParameters& s) { frame.Describe(s); });
    p.Section("mapping", [&](ConfigParameters& s) {
        map.Describe(s);
        fusion.Describe(s);
    });
    p.Section("tracking", [&](ConfigParameters& s) {
        trackers.Describe(s);
        s.Section("shutter", [&](ConfigParameters& m) { shutter.Describe(m); });
        s.Section("motion", [&](ConfigParameters& m) { motion.Describe(m); });
        s.Section("prealign", [&](ConfigParameters& a) { prealign.Describe(a); });
    });
}

Status PipelineConfig::Validate() const {
    if (Status status = frame.Validate(); !status.ok()) return status;
    if (Status status = fusion.volume.Validate(); !status.ok()) return status;
    return map.Validate();
}

Pipeline::Pipeline(const PipelineConfig& config, const PinholeCamera& camera)
    : config_(config),
      camera_(camera),
      map_(config.map),
      integrator_(config.fusion, camera),
      motion_(config.motion),
      aligner_(config.prealign, camera),
      trackers_(config.trackers, camera) {}

FrameReport Pipeline::Process(const Frame& frame, const std::optional<Eigen::Isometry3d>& given) {
    FrameReport report;
    report.index = frame.index;
    report.stamp_s = frame.stamp_s;
    report.method = trackers_.method();

    // 1. Gate the depth, split the colour.
    Stopwatch watch;
    PrepareFrame(frame, config_.frame, prepared_);
    report.prepare_ms = watch.LapMs();
    report.valid_depth_fraction =
        static_cast<double>(prepared_.valid_depth_pixels) / static_cast<double>(frame.depth_m.size());

    // 2. Where was the camera?
    report.first = !motion_.last().has_value();
    if (prepared_.valid_depth_pixels == 0) {
        report.track.reason = prepared_.measured_pixels > 0
                                  ? "0 depth pixels in range: is depth_scale right?"
                                  : "0 depth pixels in the image";
    } else if (prepared_.coherent_fraction < config_.frame.min_coherent_fraction) {
        report.track.reason = fmt::format("the depth is noise: only {:.0f} % of neighbouring pixels agree",
                                          100 * prepared_.coherent_fraction);
    } else if (given) {
        report.track.T_world_camera = *given;
        report.track.status = TrackStatus::kGood;
    } else if (report.first) {
        report.track.status = TrackStatus::kGood;  // the first camera is the world
        aligner_.Align(prepared_, Eigen::Isometry3d::Identity());
    } else {
        report.track = TrackFrame(frame);
        report.warning = trackers_.TakeNote();
    }
    report.track_ms = watch.LapMs();
    if (report.tracked()) motion_.Add({frame.stamp_s, report.track.T_world_camera});

    // 3. Put it into the map, unless it would harm it.
    if (report.track.status == TrackStatus::kGood && (fusing_ || report.first)) {
        report.fusion = integrator_.Integrate(prepared_, FusionView(report.track), map_);
        report.fused = true;
        if (report.fusion.refused_blocks > 0)
            report.warning = fmt::format("{} of {} new blocks refused: mapping.max_new_blocks",
                                         report.fusion.refused_blocks,
                                         report.fusion.refused_blocks + report.fusion.new_blocks);
    }
    return report;
}

TrackResult Pipeline::TrackFrame(const Frame& frame) {
    const Eigen::Isometry3d& T_world_last = motion_.last()->T_world_camera;
    const Eigen::Isometry3d T_world_expected = motion_.Predict(frame.stamp_s);
    const Eigen::Isometry3d T_world_aligned =
        T_world_last * aligner_.Align(prepared_, T_world_last.inverse() * T_world_expected);
    return trackers_.Track({.frame = prepared_,
                            .map = map_,
                            .T_world_camera_starts = {T_world_expected, T_world_aligned},
                            .T_world_camera_last = T_world_last,
                            .since_last_s = motion_.SinceLast(frame.stamp_s),
                            .motion = ShutterOf(frame)});
}

FrameMotion Pipeline::ShutterOf(const Frame& frame) const {
    FrameMotion motion;
    motion.colour_delay_s = config_.shutter.colour_delay ? frame.colour_stamp_s - frame.stamp_s : 0.0;
    motion.depth_readout_s = config_.shutter.depth_readout_s;
    motion.colour_readout_s = config_.shutter.colour_readout_s;
    return motion;
}

Integrator::View Pipeline::FusionView(const TrackResult& track) const {
    Integrator::View view;
    view.T_world_camera = track.T_world_camera;
    view.motion = track.motion;
    view.gain = static_cast<float>(track.gain);
    view.offset = static_cast<float>(track.offset);
    return view;
}

}  // namespace tessera
