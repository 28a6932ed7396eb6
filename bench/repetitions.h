// How kernel benchmarks measure and report.
#pragma once

#include <benchmark/benchmark.h>

#include <algorithm>
#include <vector>

namespace tessera::bench {

// Several repetitions and their minimum, because other load may share the machine.
inline void TakeMinimum(benchmark::internal::Benchmark* b) {
    b->Repetitions(7)->DisplayAggregatesOnly()->ComputeStatistics(
        "min", [](const std::vector<double>& v) { return *std::min_element(v.begin(), v.end()); });
}

// Seconds per item, printed with an SI prefix.
inline benchmark::Counter PerItem(const benchmark::State& state, double items) {
    return {items * static_cast<double>(state.iterations()),
            benchmark::Counter::kIsRate | benchmark::Counter::kInvert};
}

}  // namespace tessera::bench
