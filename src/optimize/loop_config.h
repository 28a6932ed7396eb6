// Settings of loop closure and relocalisation.
#pragma once

#include "core/config.h"
#include "optimize/pose_graph.h"

namespace tessera {

struct LoopConfig {
    bool enabled = PoseGraphAvailable();
    double max_overlap = 0.8;
    bool overlaps = true;
    int max_features = 800;
    double memory_limit_mb = 1500;
    int min_gap = 8;
    int candidates = 6;
    int min_votes = 10;
    int min_inliers = 18;
    double min_spread_m = 0.12;
    double min_known_fraction = 0.35;
    double min_fit = 0.6;
    double max_disagreement_m = 0.03;
    double max_drift = 0.05;
    double min_correction_m = 0.02;
    int rebuild_frames = 20;
    bool parts = true;
    bool refine_calibration = false;  // key calibration.refine
    // No key: false if a scan keeps every frame, because these are then the frames in the file.
    bool average_frames = true;

    void Describe(ConfigParameters& parameters);
};

}  // namespace tessera
