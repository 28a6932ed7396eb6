#include "tracking/tracker.h"

namespace tessera {

const char* ToString(TrackStatus status) {
    switch (status) {
        case TrackStatus::kGood: return "good";
        case TrackStatus::kPoor: return "poor";
        case TrackStatus::kLost: return "lost";
    }
    return "?";
}

}  // namespace tessera
