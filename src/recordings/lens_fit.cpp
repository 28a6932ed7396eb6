#include "recordings/lens_fit.h"

#include <Eigen/Cholesky>
#include <iterator>
#include <limits>

namespace tessera {
namespace {

// Two rows for each point: x, then y.
using LensRows = Eigen::Matrix<double, Eigen::Dynamic, 5>;
using LensMatrix = Eigen::Matrix<double, 5, 5>;
using LensVector = Eigen::Matrix<double, 5, 1>;

// How far k1, k2, p1, p2 and k3 move each point.
LensRows LensRowsOf(std::span<const LensPoint> points) {
    LensRows rows(2 * std::ssize(points), 5);
    Eigen::Index i = 0;
    for (const LensPoint& point : points) {
        const double x = point.ideal.x(), y = point.ideal.y(), r2 = point.ideal.squaredNorm();
        rows.row(i++) << x * r2, x * r2 * r2, 2 * x * y, r2 + 2 * x * x, x * r2 * r2 * r2;
        rows.row(i++) << y * r2, y * r2 * r2, r2 + 2 * y * y, 2 * x * y, y * r2 * r2 * r2;
    }
    return rows;
}

}  // namespace

// Lawson's algorithm: least squares, in which each round multiplies a point's weight by its error.
// It tends to the smallest largest error; plain least squares are up to ten times worse in corners.
LensFit FitLens(std::span<const LensPoint> points, double focal_px) {
    constexpr int kRounds = 30;
    LensFit best{{}, std::numeric_limits<double>::infinity()};
    if (points.empty()) return best;
    const LensRows rows = LensRowsOf(points);
    Eigen::VectorXd shifts(rows.rows());
    for (std::size_t i = 0; i < points.size(); ++i)
        shifts.segment<2>(2 * static_cast<Eigen::Index>(i)) = points[i].seen - points[i].ideal;
    Eigen::VectorXd weights = Eigen::VectorXd::Ones(rows.rows());  // both rows of a point the same
    for (int round = 0; round < kRounds; ++round) {
        const LensRows weighted = rows.array().colwise() * weights.array();
        const LensVector k =
            LensMatrix(weighted.transpose() * rows).ldlt().solve(weighted.transpose() * shifts);
        Eigen::VectorXd errors = rows * k - shifts;
        for (Eigen::Index i = 0; i < errors.size(); i += 2)
            errors.segment<2>(i).setConstant(errors.segment<2>(i).norm());
        if (!k.allFinite() || !errors.allFinite()) break;
        if (errors.maxCoeff() * focal_px < best.largest_px)
            best = {{k[0], k[1], k[2], k[3], k[4]}, errors.maxCoeff() * focal_px};
        weights.array() *= errors.array();
        if (!(weights.mean() > 0)) break;
        weights /= weights.mean();
    }
    return best;
}

}  // namespace tessera
