#include "io/device_clock.h"

#include <algorithm>

namespace tessera {
namespace {

constexpr int kAgreeing = 4;           // rejected stamps in a row that define a new clock time
constexpr double kAgreeingStep_s = 1;  // and their largest step
// Shortest time between the last stamp before a restart and the first one after it.
constexpr double kLeastStep_s = 0.005;

}  // namespace

void DeviceClock::Restart() {
    has_base_ = false;
    for (Stream& stream : streams_) stream.suspects = 0;
}

DeviceClock::Reading DeviceClock::Read(int stream, std::uint64_t stamp_us, double host_s) {
    Stream& s = streams_[stream];
    const double device_s = 1e-6 * static_cast<double>(stamp_us);
    if (!has_base_ && started_)
        offset_s_ = newest_s_ + std::max(host_s - newest_host_s_, kLeastStep_s) - device_s;
    const bool first = !has_base_;
    has_base_ = true;
    const double stamp_s = device_s + offset_s_;

    Reading reading{Verdict::kGood, stamp_s, false};
    if (!first && stamp_s > newest_s_ + max_jump_s_) reading.verdict = Verdict::kAbsurd;
    if (s.last_s && stamp_s <= *s.last_s) reading.verdict = Verdict::kBackwards;
    if (reading.verdict == Verdict::kGood) {
        s.last_s = stamp_s;
        s.suspects = 0;
        newest_s_ = first || !started_ ? stamp_s : std::max(newest_s_, stamp_s);
        newest_host_s_ = host_s;
        started_ = true;
        return reading;
    }
    const bool agrees =
        s.suspects > 0 && device_s > *s.suspect_s && device_s < *s.suspect_s + kAgreeingStep_s;
    s.suspects = agrees ? s.suspects + 1 : 1;
    s.suspect_s = device_s;
    if (s.suspects < kAgreeing) return reading;
    Restart();
    reading = Read(stream, stamp_us, host_s);
    reading.was_reset = true;
    return reading;
}

}  // namespace tessera
