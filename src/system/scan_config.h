// Settings of --scan and --resume.
#pragma once

#include "core/config.h"

namespace tessera {

struct ScanConfig {
    enum class Frames { kLoops, kAll };

    double interval_s = 0.5;
    Frames frames = Frames::kLoops;

    void Describe(ConfigParameters& parameters);
};

}  // namespace tessera
