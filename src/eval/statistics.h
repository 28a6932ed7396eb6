// Mean, spread and extremes of a list of errors. Sums follow the order of the list, so that the
// results do not depend on the number of threads.
#pragma once

#include <vector>

namespace tessera {

struct ErrorStatistics {
    double rmse = 0, mean = 0, std = 0;  // std is the population value, about the mean
    double median = 0;                   // for an even count, the mean of the middle two
    double max = 0;
};

// All zero for an empty list. Errors must be finite and non-negative. Thread-safe.
ErrorStatistics Summarise(std::vector<double> errors);

}  // namespace tessera
