// Mean, spread and extremes of a list of errors, summed in the list's order so that the figures do
// not depend on the number of threads.
#pragma once

#include <vector>

namespace tessera {

struct ErrorStatistics {
    double rmse = 0, mean = 0, std = 0;  // std: population, about the mean
    double median = 0;                   // of an even count: the mean of the two in the middle
    double max = 0;
};

// All zero for an empty list. Errors are not negative and finite. Thread-safe.
ErrorStatistics Summarise(std::vector<double> errors);

}  // namespace tessera
