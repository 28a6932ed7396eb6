// How well a run goes, as a traffic light and in words. Green only if all is well. A pure function,
// thread-safe.
#pragma once

#include <string>

#include "system/viewer_link.h"

namespace tessera {

enum class QualityLevel { kIdle, kGood, kWarning, kBad };

struct Quality {
    QualityLevel level = QualityLevel::kIdle;
    std::string title, reason;
};

struct QualitySigns {
    const FrameUpdate* frame = nullptr;  // the newest; null before the first
    RunCounts recent;                    // RecentFrames::counts
    double silent_s = 0;                 // RecentFrames::SilentFor_s
    bool ended = false, paused = false;
    bool fusing = true;  // as set by the user
    bool detector_failed = false;
};

// More than this share of the last frames dropped or left out of the map is worth a warning.
inline constexpr double kManyDropped = 0.1;

Quality QualityOf(const QualitySigns& signs);

}  // namespace tessera
