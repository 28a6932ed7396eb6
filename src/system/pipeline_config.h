// Settings of the whole pipeline: sections frame, mapping, tracking, moving.
#pragma once

#include "core/config.h"
#include "mapping/block_map.h"
#include "mapping/integrator.h"
#include "mapping/prepared_frame.h"
#include "system/motion_model.h"
#include "system/tracking_method.h"
#include "tracking/image_aligner.h"
#include "tracking/moving_detector.h"

namespace tessera {

// When a frame's images and rows were exposed.
struct ShutterConfig {
    bool colour_delay = true;
    double depth_readout_s = 0;
    double colour_readout_s = 0;

    void Describe(ConfigParameters& parameters);
};

struct PipelineConfig {
    PreparedFrame::Config frame;
    BlockMap::Config map;
    // A run sets map.band_per_m to this many standard deviations of inverse depth in the first
    // views; 0: as given.
    double band_sigmas = 4;
    Integrator::Config fusion;
    double memory_limit_mb = 0;   // of the map's blocks; 0: no limit
    double device_memory_mb = 0;  // for --device cuda; 0: most of what is free
    MotionModel::Config motion;
    ShutterConfig shutter;
    ImageAligner::Config prealign;
    TrackersConfig trackers;
    MovingDetector::Config moving;

    bool has_memory_limit() const { return memory_limit_mb > 0; }

    void Describe(ConfigParameters& parameters);
    Status Validate() const;
};

}  // namespace tessera
