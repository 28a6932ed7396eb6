// Acceptance of Levenberg-Marquardt steps and the damping: Nielsen's rule on the gain ratio, the
// decrease of the energy over the predicted one.
#pragma once

#include <algorithm>
#include <cmath>

namespace tessera {

class LevenbergMarquardt {
  public:
    double damping() const { return damping_; }  // SolverOptions::damping

    // Accepts a step only if it decreases the energy. The damping then falls with a good gain
    // ratio; otherwise it grows faster and faster.
    bool Accept(double fall, double predicted_fall) {
        if (!(fall > 0)) {
            damping_ = std::max(damping_, kLeastAfterFailure) * growth_;
            growth_ *= kGrowth;
            return false;
        }
        const double ratio = fall / std::max(predicted_fall, 1e-30);
        damping_ *= std::clamp(1 - std::pow(2 * ratio - 1, 3), 1.0 / 3.0, kGrowth);
        growth_ = kGrowth;
        return true;
    }

  private:
    static constexpr double kFirst = 1e-6;  // close to Gauss-Newton, which usually works
    static constexpr double kLeastAfterFailure = 1e-4, kGrowth = 2.0;
    double damping_ = kFirst, growth_ = kGrowth;
};

}  // namespace tessera
