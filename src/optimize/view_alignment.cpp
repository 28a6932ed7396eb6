#include "optimize/view_alignment.h"

#include <tbb/parallel_invoke.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/quantile.h"
#include "optimize/bilinear.h"

namespace tessera {
namespace {

constexpr int kUnknowns = 8;  // motion, gain, offset
using SumVector = Eigen::Matrix<double, kUnknowns, 1>;
using SumMatrix = Eigen::Matrix<double, kUnknowns, kUnknowns>;

constexpr double kSameNormal = 0.8;
constexpr double kGateSigmas = 4;  // standard deviations
constexpr double kLeastDistanceScale = 0.3, kLeastIntensityScale = 0.01;
// Residuals of neighbouring points are correlated: this many count as one.
constexpr double kCorrelated = 10;

struct Brightness {
    double gain = 0, offset = 0;  // intensity of b = (1 + gain) times that of a, + offset
};

struct Scales {
    double distance = 1;      // in units of ViewPoint::sigma_m
    double intensity = 0.05;  // [0, 1]
};

struct Sums {
    SumMatrix hessian = SumMatrix::Zero();
    SumVector gradient = SumVector::Zero();
    int points = 0, seen = 0, fit = 0;
    std::vector<float> distances, intensities;  // absolute, in the units of Scales

    // Student's t weight with a few degrees of freedom.
    void Add(const SumVector& j, double r, double scale) {
        const double in_scales = r / scale;
        const double w = 1 / ((1 + 0.25 * in_scales * in_scales) * scale * scale);
        hessian.selfadjointView<Eigen::Upper>().rankUpdate(j, w);
        gradient += j * (w * r);
    }
};

// Points of `from` in `to`. The increment is a left one of T_to_from; `to_unknown` maps the common
// unknown to it.
void AddOneWay(const DenseView::Level& from, const DenseView::Level& to,
               const Eigen::Isometry3d& T_to_from, const Matrix6d& to_unknown, bool from_a,
               const Brightness& brightness, const Scales& scales, double gate_m, Sums& sums) {
    const PinholeCamera& c = to.camera;
    const Eigen::Matrix3d R = T_to_from.linear();
    for (const ViewPoint& point : from.points) {
        ++sums.points;
        const Eigen::Vector3d q = T_to_from * point.p_camera.cast<double>();
        if (q.z() < 0.1) continue;
        const Eigen::Vector2d pixel = c.Project(q);
        if (!(pixel.x() >= 1 && pixel.y() >= 1 && pixel.x() < c.width - 2 &&
              pixel.y() < c.height - 2))
            continue;
        const int x = static_cast<int>(std::lround(pixel.x())),
                  y = static_cast<int>(std::lround(pixel.y()));
        const float z = to.depth_m(x, y);
        const Eigen::Vector3d normal = to.normal(x, y).cast<double>();
        if (z <= 0 || normal.isZero()) continue;
        ++sums.seen;
        const double off_m = normal.dot(q - c.Unproject(x, y, z));
        if (std::abs(off_m) > gate_m + kGateSigmas * point.sigma_m) continue;
        if (normal.dot(R * point.normal.cast<double>()) < kSameNormal) continue;
        SumVector j = SumVector::Zero();
        const double sigma = std::numbers::sqrt2 * point.sigma_m;
        Vector6d own;
        own << q.cross(normal), normal;
        j.head<6>() = to_unknown.transpose() * own / sigma;
        const double r = off_m / sigma;
        sums.distances.push_back(static_cast<float>(std::abs(r)));
        sums.fit += std::abs(r) < 3 * scales.distance;
        sums.Add(j, r, scales.distance);

        if (point.intensity < 0) continue;
        const BilinearSample seen = SampleBilinear(to.intensity, pixel.x(), pixel.y());
        if (seen.least < 0) continue;
        const double inverse_z = 1 / q.z(), dx = pixel.x() - c.cx, dy = pixel.y() - c.cy;
        const Eigen::Vector3d g(seen.du * c.fx * inverse_z, seen.dv * c.fy * inverse_z,
                                -(seen.du * dx + seen.dv * dy) * inverse_z);
        own << q.cross(g), g;
        j.head<6>() = to_unknown.transpose() * own;
        const double gain = 1 + brightness.gain;
        double e = 0;
        if (from_a) {
            e = seen.value - gain * point.intensity - brightness.offset;
            j(6) = -point.intensity;
            j(7) = -1;
        } else {
            e = gain * seen.value + brightness.offset - point.intensity;
            j.head<6>() *= gain;
            j(6) = seen.value;
            j(7) = 1;
        }
        sums.intensities.push_back(static_cast<float>(std::abs(e)));
        sums.Add(j, e, scales.intensity);
    }
}

// The sums of both directions, at brightness and scales so far. The unknown is a right increment x
// of T_a_b: T_a_b exp(x) = exp(Ad(T_a_b) x) T_a_b, and its inverse is exp(-x) T_b_a.
struct BothWays {
    Sums forth, back;

    void Sum(const DenseView::Level& a, const DenseView::Level& b, const Eigen::Isometry3d& T_a_b,
             const Brightness& brightness, const Scales& scales, double gate_m) {
        forth = back = Sums();
        const Eigen::Isometry3d T_b_a = T_a_b.inverse();
        tbb::parallel_invoke(
            [&] {
                AddOneWay(a, b, T_b_a, -Matrix6d::Identity(), true, brightness, scales, gate_m,
                          forth);
            },
            [&] {
                AddOneWay(b, a, T_a_b, Adjoint(T_a_b), false, brightness, scales, gate_m, back);
            });
    }
    SumMatrix Hessian() const {
        SumMatrix hessian = forth.hessian + back.hessian;
        hessian.triangularView<Eigen::Lower>() = hessian.transpose();
        return hessian;
    }
};

std::vector<float> Joined(const std::vector<float>& a, const std::vector<float>& b) {
    std::vector<float> joined = a;
    joined.insert(joined.end(), b.begin(), b.end());
    return joined;
}

// Gain and offset are eliminated.
Matrix6d InformationOf(const SumMatrix& hessian) {
    Eigen::Matrix2d own = hessian.bottomRightCorner<2, 2>();
    own.diagonal().array() += 1e-6;
    return (hessian.topLeftCorner<6, 6>() -
            hessian.topRightCorner<6, 2>() * own.inverse() * hessian.bottomLeftCorner<2, 6>()) /
           kCorrelated;
}

// Robust standard deviation of absolute values.
double ScaleOf(const std::vector<float>& sizes) {
    return sizes.empty() ? 0 : 1.4826 * Median(sizes);
}

}  // namespace

ViewAlignment AlignViews(const DenseView& a, const DenseView& b, const Eigen::Isometry3d& T_a_b) {
    constexpr int kIterations[DenseView::kLevels] = {8, 6, 5};
    constexpr double kGates_m[DenseView::kLevels] = {0.25, 0.1, 0.03};
    constexpr int kLeastPoints = 30;
    constexpr double kLongest = 0.1;  // step, metres and radians
    ViewAlignment result;
    result.T_a_b = T_a_b;
    if (a.empty() || b.empty()) return result;
    Brightness brightness;
    Scales scales;
    BothWays sums;
    Vector6d step = Vector6d::Zero();
    for (std::size_t level = 0; level < a.levels.size(); ++level)
        for (int i = 0; i < kIterations[level]; ++i) {
            sums.Sum(a.levels[level], b.levels[level], result.T_a_b, brightness, scales,
                     kGates_m[level]);
            const SumMatrix hessian = sums.Hessian();
            const std::vector<float> distances = Joined(sums.forth.distances, sums.back.distances);
            if (static_cast<int>(distances.size()) < kLeastPoints) return result;
            scales.distance = std::max(ScaleOf(distances), kLeastDistanceScale);
            scales.intensity =
                std::max(ScaleOf(Joined(sums.forth.intensities, sums.back.intensities)),
                         kLeastIntensityScale);
            SumMatrix damped = hessian;
            damped.diagonal() *= 1 + 1e-6;
            damped.diagonal().array() += 1e-3;
            const SumVector all = -damped.ldlt().solve(sums.forth.gradient + sums.back.gradient);
            step = all.head<6>();
            if (!all.allFinite()) return result;
            const double size = std::max(step.head<3>().norm(), step.tail<3>().norm());
            if (size > kLongest) step *= kLongest / size;
            result.T_a_b = Normalised(result.T_a_b * Se3Exp(step));
            brightness.gain += all(6);
            brightness.offset += all(7);
            result.information = InformationOf(hessian);
        }
    const auto share = [](int part, int whole) {
        return whole > 0 ? static_cast<double>(part) / whole : 0.0;
    };
    result.overlap = std::min(share(sums.forth.seen, sums.forth.points),
                              share(sums.back.seen, sums.back.points));
    result.fit =
        std::min(share(sums.forth.fit, sums.forth.seen), share(sums.back.fit, sums.back.seen));
    result.converged = step.head<3>().norm() < 2e-3 && step.tail<3>().norm() < 2e-3;
    return result;
}

}  // namespace tessera
