#include "tracking/residual_errors.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>

#include "core/se3.h"

namespace tessera {
namespace {

// Errors are assumed to be shared within regions of the image, but not beyond: depth deformation,
// calibration and exposure err over large parts of it (docs/information.md shows how the variance
// grows with the region).
constexpr int kRegionColumns = 5, kRegionRows = 4, kRegions = kRegionColumns * kRegionRows;
constexpr int kLeastRegions = 5;

// Divides a rectangle of blocks, whose rows follow each other, into regions.
struct RegionGrid {
    int image_columns;  // blocks in a row of the image
    int columns, rows;
    int first_column = 0, first_row = 0;

    bool Has(int block) const {
        const int column = block % image_columns - first_column,
                  row = block / image_columns - first_row;
        return column >= 0 && column < columns && row >= 0 && row < rows;
    }
    // Only if Has(block).
    std::size_t RegionOf(int block) const {
        const int column = block % image_columns - first_column,
                  row = block / image_columns - first_row;
        return static_cast<std::size_t>(row * kRegionRows / rows * kRegionColumns +
                                        column * kRegionColumns / columns);
    }
};

// The whole image; or if what is seen covers too few of its regions, the rectangle around that: a
// small object is seen by itself.
template <class Seen>
RegionGrid GridOf(int columns, int blocks, const Seen& seen) {
    const RegionGrid image{columns, columns, blocks / columns};
    std::array<bool, kRegions> covered{};
    int x0 = columns, x1 = -1, y0 = image.rows, y1 = -1;
    for (int block = 0; block < blocks; ++block) {
        if (!seen(block)) continue;
        covered[image.RegionOf(block)] = true;
        x0 = std::min(x0, block % columns);
        x1 = std::max(x1, block % columns);
        y0 = std::min(y0, block / columns);
        y1 = std::max(y1, block / columns);
    }
    if (x1 < 0 || std::ranges::count(covered, true) >= kLeastRegions) return image;
    return {columns, x1 - x0 + 1, y1 - y0 + 1, x0, y0};
}

// The scores (weight times Jacobian times residual) and Hessians of the image's regions.
template <int kUnknowns>
struct Regions {
    using Vector = Eigen::Matrix<double, kUnknowns, 1>;
    using Matrix = Eigen::Matrix<double, kUnknowns, kUnknowns>;
    std::array<Vector, kRegions> scores;
    std::array<Matrix, kRegions> hessians;

    Regions() {
        scores.fill(Vector::Zero());
        hessians.fill(Matrix::Zero());
    }

    // The variance of a residual as it counts in a sum: the covariance of the regions' scores over
    // the Hessian, at the solution that fits these residuals best. For independent residuals this
    // is their variance; correlated errors of neighbours make it larger. 0 if there are too few
    // regions.
    double Variance() const {
        Vector score = Vector::Zero();
        Matrix H = Matrix::Zero(), covariance = Matrix::Zero();
        int seen = 0;
        for (std::size_t i = 0; i < kRegions; ++i) {
            score += scores[i];
            H += hessians[i];
            seen += hessians[i].trace() > 0;
        }
        if (seen < kLeastRegions) return 0;
        // Fraction of the trace. A motion that nothing observes has no score either.
        constexpr double kRegular = 1e-9;
        const Eigen::LDLT<Matrix> solver(H + kRegular * H.trace() * Matrix::Identity());
        const Vector best = solver.solve(score);
        for (std::size_t i = 0; i < kRegions; ++i) {
            const Vector at_best = scores[i] - hessians[i] * best;
            covariance += at_best * at_best.transpose();
        }
        return solver.solve(covariance).trace() / kUnknowns;
    }
};

}  // namespace

double DistanceVariance(const ResidualEvidence& e, double shared_m) {
    Vector6d to_metres = Vector6d::Ones();
    to_metres.head<3>() /= e.scene_depth_m;
    Regions<6> regions;
    double weights = 0, weights2 = 0;
    const int blocks = DistanceSums::Groups(e.arguments) / 4;
    const double* const sums = e.sums.distances.data();
    const RegionGrid grid = GridOf(DistanceSums::Columns(e.arguments), blocks, [sums](int block) {
        const double* const s = sums + 4 * block * DistanceSums::kSums;
        constexpr int kNext = DistanceSums::kSums;
        return s[0] > 0 || s[kNext] > 0 || s[2 * kNext] > 0 || s[3 * kNext] > 0;
    });
    for (int block = 0; block < blocks; ++block) {
        if (!grid.Has(block)) continue;
        const std::size_t region = grid.RegionOf(block);
        for (int patch = 4 * block; patch < 4 * block + 4; ++patch) {
            const double* const s = sums + patch * DistanceSums::kSums;
            if (s[0] <= 0) continue;
            const Vector6d jacobian =
                to_metres.asDiagonal() * Eigen::Map<const Vector6d>(s + DistanceSums::kJacobian);
            regions.scores[region] +=
                to_metres.asDiagonal() * Eigen::Map<const Vector6d>(s + DistanceSums::kScore);
            regions.hessians[region] += jacobian * jacobian.transpose() / s[0];
            weights += s[0];
            weights2 += s[0] * s[0];
        }
    }
    const double variance = regions.Variance();
    return variance > 0 ? variance + shared_m * shared_m * weights2 / weights : 0;
}

IntensityErrors IntensityErrorsOf(const ResidualEvidence& e, double shading_error) {
    Regions<2> regions;
    double shading_scores2 = 0, information = 0, both = 0, map2 = 0, map_scores2 = 0;
    const int blocks = ScoreSums::Groups(e.arguments);
    const double* const sums = e.sums.scores.data();
    const RegionGrid grid = GridOf(ScoreSums::Columns(e.arguments), blocks, [sums](int block) {
        return sums[block * ScoreSums::kSums + 4] > 0;
    });
    for (int block = 0; block < blocks; ++block) {
        const double* const s = sums + block * ScoreSums::kSums;
        if (grid.Has(block)) {
            const std::size_t region = grid.RegionOf(block);
            regions.scores[region] += Eigen::Vector2d(s[0], s[1]);
            regions.hessians[region] += 0.5 * s[4] * Eigen::Matrix2d::Identity();
        }
        shading_scores2 += s[2] * s[2] + s[3] * s[3];
        information += s[4];
        both += s[5] - (s[7] > 0 ? (s[2] * s[8] + s[3] * s[9]) / s[7] : 0);
        map2 += s[6];
        map_scores2 += s[8] * s[8] + s[9] * s[9];
    }
    IntensityErrors errors;
    const double scatter = regions.Variance(), shared = shading_error * shading_error;
    if (scatter <= 0 || map2 <= 0) return errors;
    errors.variance = scatter + shared * shading_scores2 / information;
    errors.scatter = scatter;
    errors.shading = shared * map_scores2 / map2;
    errors.texture = std::clamp(both / map2, 0.0, 1.0);
    return errors;
}

}  // namespace tessera
