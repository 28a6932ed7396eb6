// How long each stage of a run took, frame by frame, and what the process used. Plain values; owner
// thread only.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace tessera {

struct StageStatistics {
    double mean_ms = 0;
    double median_ms = 0;  // of an even count: the mean of the two in the middle
    double p95_ms = 0;     // nearest rank: at least 95 % are not longer
    double max_ms = 0;
};

// All zero for no durations.
StageStatistics SummariseDurations(std::vector<double> durations_ms);

class StageTimes {
  public:
    void Add(const std::string& stage, double duration_ms);
    // In the order in which the stages were first seen.
    std::vector<std::pair<std::string, StageStatistics>> Summarise() const;

  private:
    std::vector<std::pair<std::string, std::vector<double>>> durations_ms_;
};

struct ProcessUsage {
    double cpu_s = 0;        // user and system time of all threads since the process began
    double peak_rss_mb = 0;  // 2^20 bytes
};
ProcessUsage MeasureProcess();

// What was freed goes back to the system now, as far as the allocator can: before something large
// is made that need not stand beside it. Costs some milliseconds. Thread-safe.
void ReturnFreeMemory();

}  // namespace tessera
