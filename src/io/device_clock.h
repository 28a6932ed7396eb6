// A camera's own time stamps, made trustworthy: checked one by one, and going on when the camera's
// clock begins anew.
#pragma once

#include <cstdint>
#include <optional>

namespace tessera {

// Stamps of two streams that share a clock. Owner thread only.
class DeviceClock {
  public:
    enum class Verdict {
        kGood,
        kBackwards,  // not after the stream's last good stamp
        kAbsurd,     // farther ahead than max_jump_s
    };
    struct Reading {
        Verdict verdict = Verdict::kGood;
        double stamp_s = 0;  // meaningful if kGood
        // Several stamps in a row agreed on another time: taken as the clock's new one.
        bool was_reset = false;
    };

    explicit DeviceClock(double max_jump_s) : max_jump_s_(max_jump_s) {}

    // The stamp of an image of stream 0 or 1 that came at host_s (any steady clock, seconds). Until
    // the first Restart stamp_s is stamp_us in seconds.
    Reading Read(int stream, std::uint64_t stamp_us, double host_s);

    // The next stamp may be anything (another device, or the same after a reset); the time that it
    // amounts to follows the last one by as long as it took.
    void Restart();

  private:
    struct Stream {
        std::optional<double> last_s;     // last good stamp, in the source's time
        std::optional<double> suspect_s;  // last refused one, in the device's time
        int suspects = 0;                 // that in a row make sense among themselves
    };

    double max_jump_s_;
    Stream streams_[2];
    double offset_s_ = 0;       // source's time - device's time
    double newest_s_ = 0;       // newest good stamp of either stream
    double newest_host_s_ = 0;  // when it came
    bool started_ = false;      // newest_s_ is meaningful
    bool has_base_ = false;     // offset_s_ fits the device's present clock
};

}  // namespace tessera
