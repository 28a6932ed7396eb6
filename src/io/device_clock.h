// Validates a camera's own time stamps one by one, and continues them when the camera's clock
// restarts.
#pragma once

#include <cstdint>
#include <optional>

namespace tessera {

// Time stamps of two streams that share a clock. Owner thread only.
class DeviceClock {
  public:
    enum class Verdict {
        kGood,
        kBackwards,  // not later than the stream's last good stamp
        kAbsurd,     // more than max_jump_s ahead
    };
    struct Reading {
        Verdict verdict = Verdict::kGood;
        double stamp_s = 0;  // meaningful if kGood
        // Several stamps in a row agreed on another time, which is now the new clock time.
        bool was_reset = false;
    };

    explicit DeviceClock(double max_jump_s) : max_jump_s_(max_jump_s) {}

    // Checks the stamp of an image of stream 0 or 1 that arrived at host_s (any steady clock,
    // seconds). Until the first Restart, stamp_s is stamp_us in seconds.
    Reading Read(int stream, std::uint64_t stamp_us, double host_s);

    // Call this when the next stamp may have any value (another device, or the same one after a
    // reset). Its output time then follows the last one by the host time elapsed in between.
    void Restart();

  private:
    struct Stream {
        std::optional<double> last_s;     // last good stamp, in the source's time
        std::optional<double> suspect_s;  // last rejected stamp, in the device's time
        int suspects = 0;                 // rejected stamps in a row that agree with each other
    };

    double max_jump_s_;
    Stream streams_[2];
    double offset_s_ = 0;       // source's time - device's time
    double newest_s_ = 0;       // newest good stamp of either stream
    double newest_host_s_ = 0;  // host time at which it arrived
    bool started_ = false;      // newest_s_ is meaningful
    bool has_base_ = false;     // offset_s_ fits the device's current clock
};

}  // namespace tessera
