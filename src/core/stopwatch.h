// Wall-clock time of consecutive steps.
#pragma once

#include <chrono>

namespace tessera {

class Stopwatch {
  public:
    // Milliseconds since construction or the last lap.
    double LapMs() {
        const Clock::time_point now = Clock::now();
        const double ms = std::chrono::duration<double, std::milli>(now - start_).count();
        start_ = now;
        return ms;
    }

    // Like LapMs, but does not start a new lap.
    double ElapsedMs() const {
        return std::chrono::duration<double, std::milli>(Clock::now() - start_).count();
    }

  private:
    using Clock = std::chrono::steady_clock;
    Clock::time_point start_ = Clock::now();
};

}  // namespace tessera
