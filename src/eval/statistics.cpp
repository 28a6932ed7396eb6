#include "eval/statistics.h"

#include <algorithm>
#include <cmath>

namespace tessera {

ErrorStatistics Summarise(std::vector<double> errors) {
    ErrorStatistics s;
    if (errors.empty()) return s;
    const double count = static_cast<double>(errors.size());
    double sum = 0, sum_of_squares = 0;
    for (const double error : errors) {
        sum += error;
        sum_of_squares += error * error;
    }
    s.mean = sum / count;
    s.rmse = std::sqrt(sum_of_squares / count);
    double spread = 0;
    for (const double error : errors) spread += (error - s.mean) * (error - s.mean);
    s.std = std::sqrt(spread / count);

    const auto middle = errors.begin() + static_cast<std::ptrdiff_t>(errors.size() / 2);
    std::nth_element(errors.begin(), middle, errors.end());
    s.median = *middle;
    if (errors.size() % 2 == 0)
        s.median = (s.median + *std::max_element(errors.begin(), middle)) / 2;
    s.max = *std::max_element(middle, errors.end());
    return s;
}

}  // namespace tessera
