#include "synth/synthetic_source.h"

#include <cmath>
#include <span>
#include <utility>

namespace tessera {

void SynthConfig::Describe(ConfigParameters& p) {
    p.Add("frames", frames, {0, 10000000}, "",
          "number of frames; 0 = to the end of the camera path");
    p.Add("seed", seed, {0, 2147483647}, "", "random seed of the sensor noise");
    p.Add("fps", fps, {0.1, 1000}, "1/s", "frames per second");
    p.Add("width", camera.width, {16, 8192}, "px", "image width");
    p.Add("height", camera.height, {16, 8192}, "px", "image height");
    p.Add("fx", camera.fx, {1, 1e5}, "px", "focal length along x");
    p.Add("fy", camera.fy, {1, 1e5}, "px", "focal length along y");
    p.Add("cx", camera.cx, {-8192, 16384}, "px", "principal point, x");
    p.Add("cy", camera.cy, {-8192, 16384}, "px", "principal point, y");
    p.Add("trajectory", trajectory,
          "TUM trajectory file for the camera; empty = the scene's own path");
    p.Add("trajectory_from_start", trajectory_from_start,
          "on: move the trajectory so that it starts at the first pose of the scene's own path; "
          "off: use its poses as they are, in the scene's world frame");
    p.AddChoice("model_up", model_up, {{"y", UpAxis::kY}, {"z", UpAxis::kZ}},
                "up axis of an .obj model; affects only the generated camera path");
    p.Add("speed", speed, {0.1, 10}, "", "speed factor of the camera path");
    p.Section("rig", [this](ConfigParameters& s) { rig.Describe(s); });
    p.Section("sensor", [this](ConfigParameters& s) { sensor.Describe(s); });
    p.Section("faults", [this](ConfigParameters& s) { faults.Describe(s); });
}

Status SynthConfig::Validate() const {
    if (const Status status = CheckPlausible(camera); !status.ok())
        return Status::Error("synthetic." + status.message() +
                             "; set fx, fy, cx and cy along with width and height");
    if (sensor.min_depth_m >= sensor.max_depth_m)
        return Status::Error(
            fmt::format("synthetic.sensor.min_depth_m: {} m is not below max_depth_m, {} m",
                        sensor.min_depth_m, sensor.max_depth_m));
    return Status::Ok();
}

SyntheticSource::SyntheticSource(std::string name, StagedScene staged, const SynthConfig& config)
    : config_(config),
      staged_(std::move(staged)),
      renderer_(*staged_.scene, config.camera, config.rig),
      sensor_(config.sensor, config.camera, static_cast<std::uint64_t>(config.seed)),
      faults_(config.faults, config.camera, static_cast<std::uint64_t>(config.seed)) {
    info_.name = std::move(name);
    info_.kind = "synthetic scene";
    info_.camera = config.camera;
    info_.fps = config.fps;
    info_.has_truth = true;
    info_.frame_count = config.frames;
    if (config.frames == 0)
        info_.frame_count =
            std::max<std::int64_t>(std::llround(staged_.path.duration_s * config.fps), 1);
    info_.notes = {staged_.description};
}

ReadResult SyntheticSource::Read(Frame& frame) {
    ReadResult read = ReadFrame(frame, view_, false);
    if (read.status == ReadStatus::kOk) faults_.Apply(frame);
    return read;
}

ReadResult SyntheticSource::ReadWithTruth(Frame& frame, RenderedView& truth) {
    return ReadFrame(frame, truth, true);
}

ReadResult SyntheticSource::ReadFrame(Frame& frame, RenderedView& truth, bool with_patches) {
    if (next_ >= info_.frame_count) return {ReadStatus::kEnd, ""};
    const std::int64_t index = next_++;
    const double time_s = static_cast<double>(index) / config_.fps;
    renderer_.Render(staged_.path, time_s, sensor_.exposure_s(), truth, with_patches);
    frame.index = index;
    frame.stamp_s = frame.colour_stamp_s = kFirstStamp_s + time_s;
    frame.T_world_camera = staged_.path.T_world_camera(time_s);
    sensor_.SenseDepth(truth, index, frame.depth_m);
    if (config_.rig.depth_scale != 1)
        for (float& z_m : std::span(frame.depth_m.data(), frame.depth_m.size()))
            z_m *= static_cast<float>(config_.rig.depth_scale);
    sensor_.SenseColour(truth, index, time_s, frame.colour);
    return {ReadStatus::kOk, ""};
}

}  // namespace tessera
