// Time per stage and frame. Plain values; owner thread only.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace tessera {

struct StageStatistics {
    double mean_ms = 0;
    double median_ms = 0;  // for an even count, the mean of the middle two
    double p95_ms = 0;     // nearest rank: at least 95 % of the durations are not longer
    double max_ms = 0;
};

// All zero if there are no durations.
StageStatistics SummariseDurations(std::vector<double> durations_ms);

class StageTimes {
  public:
    void Add(const std::string& stage, double duration_ms);
    // In the order in which the stages first appeared.
    std::vector<std::pair<std::string, StageStatistics>> Summarise() const;

  private:
    std::vector<std::pair<std::string, std::vector<double>>> durations_ms_;
};

}  // namespace tessera
