#include "run/timings.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace tessera {

StageStatistics SummariseDurations(std::vector<double> durations_ms) {
    if (durations_ms.empty()) return {};
    std::sort(durations_ms.begin(), durations_ms.end());
    const std::size_t n = durations_ms.size();
    const auto rank = static_cast<std::size_t>(std::ceil(0.95 * static_cast<double>(n)));
    StageStatistics s;
    s.mean_ms =
        std::accumulate(durations_ms.begin(), durations_ms.end(), 0.0) / static_cast<double>(n);
    s.median_ms = (durations_ms[(n - 1) / 2] + durations_ms[n / 2]) / 2;
    s.p95_ms = durations_ms[rank - 1];
    s.max_ms = durations_ms.back();
    return s;
}

void StageTimes::Add(const std::string& stage, double duration_ms) {
    auto found = std::find_if(durations_ms_.begin(), durations_ms_.end(),
                              [&](const auto& entry) { return entry.first == stage; });
    if (found == durations_ms_.end())
        found = durations_ms_.insert(durations_ms_.end(), {stage, {}});
    found->second.push_back(duration_ms);
}

std::vector<std::pair<std::string, StageStatistics>> StageTimes::Summarise() const {
    std::vector<std::pair<std::string, StageStatistics>> summary;
    for (const auto& [stage, durations] : durations_ms_)
        summary.emplace_back(stage, SummariseDurations(durations));
    return summary;
}

}  // namespace tessera
