#include "system/run_config.h"

#include <filesystem>

namespace tessera {

void ScanConfig::Describe(ConfigParameters& p) {
    p.Add("interval_s", interval_s, {0.05, 60.0}, "s",
          "longest time between two checkpoints, by the clock or by the frames' stamps: the most "
          "that a crash can lose");
    p.AddChoice("frames", frames, {{"loops", Frames::kLoops}, {"all", Frames::kAll}},
                "raw frames in the file: loops = those that loop closure keeps (none without it); "
                "all = every frame, so that the scan can be replayed, at 0.25 MB per frame");
}

void LiveConfig::Describe(ConfigParameters& p) {
    p.Add("queue_frames", queue_frames, {1, 30}, "frames",
          "maximum number of frames waiting to be tracked before the oldest is dropped; more "
          "bridge short stalls but add delay");
    p.Add("mesh_blocks", mesh_blocks, {1, 1000000}, "blocks",
          "maximum number of blocks remeshed after each frame for the window: about 5 us each on "
          "one core");
    p.Add("playback_speed", playback_speed, {0.01, 1000.0}, "",
          "playback speed of recorded sources, relative to the recorded pace; cameras keep their "
          "own pace");
    p.Add("extra_tracking_ms", extra_tracking_ms, {0.0, 10000.0}, "ms",
          "added to the tracking time of each frame, to simulate a slower machine");
    p.Add("extra_mapping_ms", extra_mapping_ms, {0.0, 10000.0}, "ms",
          "added to the fusion time of each frame, to simulate a slower machine");
}

void ViewConfig::Describe(ConfigParameters& p) {
    p.Add("width", width, {320, 16384}, "px",
          "initial width of the window, on a display of normal density");
    p.Add("height", height, {240, 16384}, "px", "initial height of the window, likewise");
    p.Add("close_at_end", close_at_end,
          "close the window when the run ends; off: it stays open until the user closes it");
}

void RunConfig::Describe(ConfigParameters& p) {
    p.Section("source", [&](ConfigParameters& s) {
        source.Describe(s);
        s.Section("openni", [&](ConfigParameters& camera) { openni.Describe(camera); });
    });
    p.Section("synthetic", [&](ConfigParameters& s) { synthetic.Describe(s); });
    pipeline.Describe(p);
    p.Section("meshing", [&](ConfigParameters& s) { meshing.Describe(s); });
    p.Section("labels", [&](ConfigParameters& s) { labels.Describe(s); });
    p.Section("loops", [&](ConfigParameters& s) { loops.Describe(s); });
    p.Section("calibration", [&](ConfigParameters& s) {
        s.Add("check", check_camera,
              "before a recording is run, estimate its focal length and centre from its first 8 "
              "seconds. If they contradict camera.yaml, warn and use the estimate for this run; "
              "without camera.yaml, use the estimate. Also estimate errors of colour and of depth "
              "and correct them. off: use camera.yaml and the images as they are");
        s.Add("refine", loops.refine_calibration,
              "at the end, estimate focal length and disparity offset from the keyframes and, if "
              "the scan shows that they are off, rebuild the map with the new values; needs "
              "--loop-closure on");
    });
    p.Section("scan", [&](ConfigParameters& s) { scan.Describe(s); });
    p.Section("live", [&](ConfigParameters& s) { live.Describe(s); });
    p.Section("view", [&](ConfigParameters& s) { view.Describe(s); });
    p.Section("record", [&](ConfigParameters& s) { record.Describe(s); });
    p.Section("run", [&](ConfigParameters& s) {
        s.Add("threads", threads, {0, 256}, "",
              "threads for parallel loops, 0 = one per core; results do not depend on it");
        s.Add("read_ahead", read_ahead, {1, 64}, "frames",
              "frames decoded ahead on a separate thread; more help only if reading stalls");
        s.Add("memory_limit_mb", memory_limit_mb, {0, 1e7}, "MB",
              "the run ends, and writes everything, before the whole process takes more; 0: what "
              "the machine or its container has");
    });
}

LoopConfig RunConfig::EffectiveLoops() const {
    LoopConfig effective = loops;
    effective.average_frames = scan.frames != ScanConfig::Frames::kAll;
    // The volume is of one part.
    effective.parts = loops.parts && !pipeline.fusion.volume.bounded;
    return effective;
}

Status RunConfig::Validate() const {
    if (Status status = source.Validate(); !status.ok()) return status;
    if (Status status = synthetic.Validate(); !status.ok()) return status;
    if (Status status = labels.Validate(); !status.ok()) return status;
    return pipeline.Validate();
}

Status LoadPresetOrFile(const std::string& name_or_path, ConfigParameters& parameters) {
    std::string names;
    for (const Preset& preset : Presets()) {
        if (preset.name == name_or_path)
            return parameters.LoadYaml(preset.yaml, "preset " + preset.name);
        names += (names.empty() ? "" : ", ") + preset.name;
    }
    std::error_code ignored;
    if (!std::filesystem::exists(name_or_path, ignored))
        return Status::Error(
            fmt::format("{}: neither a file nor a preset ({})", name_or_path, names));
    return parameters.LoadYamlFile(name_or_path);
}

std::string ConfigurationDocument() {
    RunConfig config;
    ConfigParameters parameters;
    config.Describe(parameters);
    return "# Configuration\n\n"
           "Generated by `tessera config --markdown`; do not edit. A configuration file is YAML\n"
           "with the sections below as nested maps. `--config FILE` reads one,\n"
           "`--set section.key=value` overrides a single key. A missing key keeps its default. An\n"
           "unknown key is an error that names the nearest known key. `tessera config` prints the\n"
           "whole configuration as such a file, and every run saves the configuration it used in\n"
           "its run.json. Built-in presets: `--config default`, `--config bylow2014`,\n"
           "`--config diaz2018`, `--config labels`.\n" +
           parameters.ToMarkdown();
}

}  // namespace tessera
