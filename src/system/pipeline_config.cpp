#include "system/pipeline_config.h"

namespace tessera {

void ShutterConfig::Describe(ConfigParameters& p) {
    p.Add("colour_delay", colour_delay,
          "compensate for the camera's motion between the time stamps of the depth and colour "
          "images");
    p.Add("depth_readout_s", depth_readout_s, {-0.1, 0.1}, "s",
          "read-out time of the depth image, from its first row to its last (rolling shutter); 0 = "
          "global shutter");
    p.Add("colour_readout_s", colour_readout_s, {-0.1, 0.1}, "s", "the same for the colour image");
}

void PipelineConfig::Describe(ConfigParameters& p) {
    p.Section("frame", [&](ConfigParameters& s) { frame.Describe(s); });
    p.Section("mapping", [&](ConfigParameters& s) {
        map.Describe(s);
        s.Add("band_sigmas", band_sigmas, {0.0, 10.0}, "",
              "where truncation_m is less than this many standard deviations of the depth, as the "
              "first seconds show them, the band is wider: sets band_per_m; 0 leaves it as given");
        fusion.Describe(s);
        s.Add("memory_limit_mb", memory_limit_mb, {0.0, 1e6}, "MB",
              "maximum memory for the map's blocks, 0 = no limit: blocks far from the camera are "
              "moved to the file of --scan and loaded again before the camera sees them; all that "
              "the camera may see from one place must fit");
        s.Add("device_memory_mb", device_memory_mb, {0.0, 1e6}, "MB",
              "maximum GPU memory for --device cuda, 0 = 90 % of what is free at the start; while "
              "the map grows, its largest layer exists twice");
    });
    p.Section("tracking", [&](ConfigParameters& s) {
        trackers.Describe(s);
        s.Section("shutter", [&](ConfigParameters& m) { shutter.Describe(m); });
        s.Section("motion", [&](ConfigParameters& m) { motion.Describe(m); });
        s.Section("prealign", [&](ConfigParameters& a) { prealign.Describe(a); });
    });
    p.Section("moving", [&](ConfigParameters& s) { moving.Describe(s); });
}

Status PipelineConfig::Validate() const {
    if (Status status = frame.Validate(); !status.ok()) return status;
    if (Status status = fusion.volume.Validate(); !status.ok()) return status;
    return map.Validate();
}

}  // namespace tessera
