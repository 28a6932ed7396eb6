#include "optimize/covariance_factors.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "core/quantile.h"
#include "optimize/overlaps.h"

namespace tessera {
namespace {

// Of a chi-squared variable with six degrees of freedom.
constexpr double kUpperQuartile = 7.84;

// How tracking differs from an alignment, a right increment, and how much either lets it.
struct Difference {
    Vector6d off;
    Matrix6d aligned, tracked;  // covariances

    double Squared(const CovarianceFactors& factors) const {
        return off.dot((factors.aligned * aligned + factors.tracked * tracked).ldlt().solve(off));
    }
};

// The covariance of tracking from the first keyframe to each, about the world's origin.
std::vector<Matrix6d> TrackedFromTheFirst(const Keyframes& keyframes,
                                          std::span<const PoseEdge> edges) {
    std::vector<Matrix6d> sums(static_cast<std::size_t>(keyframes.size()), Matrix6d::Zero());
    for (const PoseEdge& edge : edges) {
        if (edge.loop) continue;
        const Matrix6d moved =
            Adjoint(keyframes[edge.to].T_world_camera) * edge.root_information.inverse();
        sums[static_cast<std::size_t>(edge.to)] += moved * moved.transpose();
    }
    for (std::size_t i = 1; i < sums.size(); ++i) sums[i] += sums[i - 1];
    return sums;
}

double UpperQuartile(const std::vector<Difference>& differences, const CovarianceFactors& factors) {
    std::vector<double> squares;
    for (const Difference& difference : differences) squares.push_back(difference.Squared(factors));
    return Quantile(squares, 0.75);
}

// Sets `factor`, which is part of `factors`, to the least one, 1 or more, that explains three
// quarters of the differences.
void Grow(const std::vector<Difference>& differences, double& factor,
          const CovarianceFactors& factors) {
    constexpr double kMost = 1e6;
    constexpr int kHalvings = 14;  // of the logarithm: to 0.1 %
    factor = 1;
    if (differences.empty() || UpperQuartile(differences, factors) <= kUpperQuartile) return;
    double low = 0, high = std::log(kMost);
    for (int i = 0; i < kHalvings; ++i) {
        const double middle = (low + high) / 2;
        factor = std::exp(middle);
        (UpperQuartile(differences, factors) > kUpperQuartile ? low : high) = middle;
    }
}

}  // namespace

std::optional<double> AlignedFactor(const Keyframes& keyframes) {
    constexpr std::size_t kFewest = 40;
    std::vector<double> squares;
    for (int id = 0; id < keyframes.size(); ++id)
        for (const Overlap& overlap : keyframes[id].overlaps)
            if (overlap.T_with_this_tracked && !IsOlder(overlap, id))
                squares.push_back(SquaredDifference(overlap));
    if (squares.size() < kFewest) return std::nullopt;
    return std::max(1.0, Quantile(squares, 0.75) / kUpperQuartile);
}

std::optional<CovarianceFactors> FindCovarianceFactors(const Keyframes& keyframes,
                                                       std::span<const PoseEdge> edges) {
    const std::optional<double> aligned = AlignedFactor(keyframes);
    if (!aligned) return std::nullopt;
    const std::vector<Matrix6d> sums = TrackedFromTheFirst(keyframes, edges);
    std::vector<Difference> near, older;
    for (int id = 0; id < keyframes.size(); ++id) {
        const Matrix6d to_camera = Adjoint(keyframes[id].T_world_camera.inverse());
        for (const Overlap& overlap : keyframes[id].overlaps) {
            if (!overlap.T_with_this_tracked) continue;
            const Matrix6d way =
                sums[static_cast<std::size_t>(id)] - sums[static_cast<std::size_t>(overlap.with)];
            // An alignment may leave motions open.
            const Matrix6d regular = overlap.information + 1e-3 * Matrix6d::Identity();
            (IsOlder(overlap, id) ? older : near)
                .push_back({TrackedOff(overlap), regular.inverse(),
                            to_camera * way * to_camera.transpose()});
        }
    }
    CovarianceFactors factors{*aligned, 1};
    Grow(older, factors.tracked, factors);
    if (factors.tracked == 1) return factors;
    // AlignedFactor takes tracking for the truth between neighbours: only what is beyond its usual
    // drift is news.
    CovarianceFactors beyond{1, factors.tracked - 1};
    Grow(near, beyond.aligned, beyond);
    factors.aligned = beyond.aligned;
    return factors;
}

}  // namespace tessera
