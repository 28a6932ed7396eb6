#include "tracking/pose_solver.h"

#include <tbb/parallel_for.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <vector>

#include "core/tile_sums.h"

namespace tessera {
namespace {

using L = SumLayout;

PoseTerm TermAt(const double* term) {
    PoseTerm out;
    int at = L::kHessian;
    for (int i = 0; i < 6; ++i) {
        for (int j = i; j < 6; ++j, ++at) out.H(i, j) = out.H(j, i) = term[at];
        out.g(i) = term[L::kGradient + i];
    }
    return out;
}

// Gain and offset: their coupling to the pose, their Hessian and gradient, including the prior.
struct BrightnessTerm {
    Eigen::Matrix<double, 6, 2> B;
    Eigen::Matrix2d C, C_inverse;
    Eigen::Vector2d h;

    BrightnessTerm(const PoseSums& sums, double prior, double gain, double offset) {
        for (int i = 0; i < 6; ++i)
            B.row(i) << sums[L::kCoupling + 2 * i], sums[L::kCoupling + 2 * i + 1];
        C << sums[L::kBrightness] + prior, sums[L::kBrightness + 1], sums[L::kBrightness + 1],
            sums[L::kBrightness + 2] + prior;
        C_inverse = C.inverse();
        h << sums[L::kBrightnessGradient] + prior * (gain - 1.0),
            sums[L::kBrightnessGradient + 1] + prior * offset;
    }
};

}  // namespace

PoseSums& PoseSums::operator+=(const PoseSums& other) {
    for (int i = 0; i < L::kCount; ++i) value[i] += other.value[i];
    return *this;
}

double IntensityRms(const PoseSums& sums) {
    return sums[L::kIntensityWeight] > 0
               ? std::sqrt(sums[L::kIntensityError] / sums[L::kIntensityWeight])
               : 0;
}

PoseSums SumPoints(int count, const std::function<void(int first, int last, double* sums)>& add) {
    const int runs = (count + kRunItems - 1) / kRunItems;
    std::vector<PoseSums> partial(static_cast<std::size_t>(runs));
    tbb::parallel_for(0, runs, [&](int run) {
        const int first = run * kRunItems;
        add(first, std::min(count, first + kRunItems),
            partial[static_cast<std::size_t>(run)].value);
    });
    PoseSums total;
    for (const PoseSums& sums : partial) total += sums;
    return total;
}

double Misfit(const PoseSums& sums, double taking_part, double points, double distance_scale_m,
              double alpha) {
    const double scale2 = distance_scale_m * distance_scale_m;
    double misfit = (1.0 - taking_part / points) * (1.0 + alpha);
    if (sums[L::kDistanceWeight] > 0)
        misfit += sums[L::kDistanceError] / (sums[L::kDistanceWeight] * scale2);
    if (sums[L::kIntensityWeight] > 0)
        misfit += alpha * sums[L::kIntensityError] / (sums[L::kIntensityWeight] * scale2);
    return misfit;
}

Matrix6d FromNormalised(const Eigen::Vector3d& camera_local, double scene_depth_m) {
    Matrix6d A = Matrix6d::Identity();
    A.topLeftCorner<3, 3>() *= 1.0 / scene_depth_m;
    // X -> c + R (x - c) moves the origin by c x omega.
    A.bottomLeftCorner<3, 3>() = Skew(camera_local) / scene_depth_m;
    return A;
}

PoseTerm DistanceTerm(const PoseSums& sums) { return TermAt(sums.value + L::kDistance); }

PoseTerm IntensityTerm(const PoseSums& sums, const SolverOptions& options, double gain,
                       double offset) {
    PoseTerm term = TermAt(sums.value + L::kIntensity);
    if (!options.estimate_brightness || sums[L::kBrightness + 2] <= 0) return term;
    const BrightnessTerm brightness(sums, options.brightness_prior, gain, offset);
    term.H -= brightness.B * brightness.C_inverse * brightness.B.transpose();
    term.g -= brightness.B * brightness.C_inverse * brightness.h;
    return term;
}

PoseTerm PoseTerm::Normalised(const Eigen::Vector3d& camera_local, double scene_depth_m) const {
    const Matrix6d A = FromNormalised(camera_local, scene_depth_m);
    return {A.transpose() * H * A, A.transpose() * g};
}

PoseStep SolvePoseStep(const PoseSums& sums, const SolverOptions& options, double gain,
                       double offset, const Eigen::Vector3d& camera_local, double scene_depth_m) {
    PoseStep step;
    const PoseTerm distance = DistanceTerm(sums),
                   intensity = IntensityTerm(sums, options, gain, offset);
    const Matrix6d H = distance.H + options.alpha * intensity.H;
    const Vector6d g = distance.g + options.alpha * intensity.g;
    if (!H.allFinite() || !g.allFinite() || H.trace() <= 0) return step;

    // Solve in the normalised coordinates, which are well scaled.
    const Matrix6d A = FromNormalised(camera_local, scene_depth_m);
    const Matrix6d N = A.transpose() * H * A;
    constexpr double kRegular = 1e-12;
    const double damping = std::max(options.damping, kRegular) * N.trace() + options.least_damping;
    step.increment = -A * (N + damping * Matrix6d::Identity()).ldlt().solve(A.transpose() * g);
    step.predicted_decrease = -step.increment.dot(2.0 * g + H * step.increment);
    if (options.estimate_brightness && sums[L::kBrightness + 2] > 0) {
        const BrightnessTerm brightness(sums, options.brightness_prior, gain, offset);
        step.predicted_decrease +=
            options.alpha * brightness.h.dot(brightness.C_inverse * brightness.h);
        const Eigen::Vector2d change =
            brightness.C_inverse * (-brightness.h - brightness.B.transpose() * step.increment);
        step.gain_change = change(0);
        step.offset_change = change(1);
    }
    step.valid = step.increment.allFinite();
    return step;
}

}  // namespace tessera
