#include "system/run_config.h"

#include <filesystem>

namespace tessera {

void LiveConfig::Describe(ConfigParameters& p) {
    p.Add("queue_frames", queue_frames, {1, 30}, "frames",
          "how many may wait to be tracked before the oldest is dropped; more bridges hiccups and "
          "adds delay");
    p.Add("mesh_blocks", mesh_blocks, {1, 1000000}, "blocks",
          "most blocks meshed again after a frame, for the window: about 5 us each on one core");
    p.Add("playback_speed", playback_speed, {0.01, 1000.0}, "",
          "recorded sources give their frames at this multiple of the recorded pace; cameras have "
          "their own");
    p.Add("extra_tracking_ms", extra_tracking_ms, {0.0, 10000.0}, "ms",
          "added to the tracking of each frame, to see what a slower machine would do");
    p.Add("extra_mapping_ms", extra_mapping_ms, {0.0, 10000.0}, "ms", "the same for its fusion");
}

void ViewConfig::Describe(ConfigParameters& p) {
    p.Add("width", width, {320, 16384}, "px",
          "of the window when it opens, on a display of usual density");
    p.Add("height", height, {240, 16384}, "px", "the same of its height");
    p.Add("close_at_end", close_at_end,
          "close the window when the run has ended; off: it stays until it is closed");
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
              "before a recording is run, find its focal length and centre from its first 8 "
              "seconds: a camera.yaml that they "
              "contradict is said and corrected for the run, a missing one made up for; off: what "
              "is given counts");
        s.Add("refine", loops.refine_calibration,
              "at the end, find focal length and disparity offset from the keyframes and, where "
              "the scan shows that they are "
              "off, make the map again with them; needs --loop-closure on");
    });
    p.Section("scan", [&](ConfigParameters& s) { scan.Describe(s); });
    p.Section("live", [&](ConfigParameters& s) { live.Describe(s); });
    p.Section("view", [&](ConfigParameters& s) { view.Describe(s); });
    p.Section("record", [&](ConfigParameters& s) { record.Describe(s); });
    p.Section("run", [&](ConfigParameters& s) {
        s.Add("threads", threads, {0, 256}, "",
              "threads of the parallel loops, 0 = one per core; results do not depend on it");
        s.Add("read_ahead", read_ahead, {1, 64}, "frames",
              "decoded ahead on a thread of their own; more helps only where reading stalls");
    });
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
           "Made by `tessera config --markdown`; do not edit. A configuration file is YAML that "
           "nests as the\n"
           "sections below do; `--config FILE` reads it, `--set section.key=value` overrides one "
           "key. A missing key\n"
           "keeps its default, an unknown one is an error that names the nearest known key. "
           "`tessera config` prints\n"
           "the whole configuration as such a file, and every run saves the one that it used in "
           "its run.json.\n"
           "Presets that come with the program: `--config default`, `--config bylow2014`.\n" +
           parameters.ToMarkdown();
}

}  // namespace tessera
