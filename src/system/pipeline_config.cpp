#include "system/pipeline_config.h"

namespace tessera {

void ShutterConfig::Describe(ConfigParameters& p) {
    p.Add("colour_delay", colour_delay,
          "allow for the camera's motion between the depth and the colour image's time stamps");
    p.Add("depth_readout_s", depth_readout_s, {-0.1, 0.1}, "s",
          "time from the depth image's first row to its last: the rolling shutter; 0 is a global "
          "one");
    p.Add("colour_readout_s", colour_readout_s, {-0.1, 0.1}, "s", "the same of the colour image");
}

void DeviceConfig::Describe(ConfigParameters& p) {
    p.Add("device_memory_mb", memory_mb, {0.0, 1e6}, "MB",
          "most memory that --device cuda takes on the GPU, 0 = nine tenths of what is free when "
          "it starts; while the map grows "
          "there, its largest layer is there twice");
}

void PipelineConfig::Describe(ConfigParameters& p) {
    p.Section("frame", [&](ConfigParameters& s) { frame.Describe(s); });
    p.Section("mapping", [&](ConfigParameters& s) {
        map.Describe(s);
        fusion.Describe(s);
        paging.Describe(s);
        device.Describe(s);
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
