#include "tracking/pose_solver.h"

#include <tbb/parallel_for.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <vector>

#include "core/tile_sums.h"

namespace tessera {
namespace {

using L = SumLayout;

// Times the least eigenvalue: where the last frame left a motion open this one holds it from here on; and where one is open, noise
// makes what little holds the others, so they are held by the scene from here on only.
constexpr double kHeldAgain = 1.5, kClearlyHeld = 3.0;

// Takes an increment about the camera with rotations in units of 1/depth to one about the local origin.
Matrix6d FromNormalised(const Eigen::Vector3d& camera_local, double depth_m) {
    Matrix6d A = Matrix6d::Identity();
    A.topLeftCorner<3, 3>() *= 1.0 / depth_m;
    A.bottomLeftCorner<3, 3>() = Skew(camera_local) / depth_m;  // x -> c + R (x - c) moves the origin by c x omega
    return A;
}

}  // namespace

PoseSums& PoseSums::operator+=(const PoseSums& other) {
    for (int i = 0; i < L::kCount; ++i) value[i] += other.value[i];
    return *this;
}

PoseSums SumPoints(int count, const std::function<void(int first, int last, double* sums)>& add) {
    const int runs = (count + kRunItems - 1) / kRunItems;
    std::vector<PoseSums> partial(static_cast<std::size_t>(runs));
    tbb::parallel_for(0, runs, [&](int run) {
        const int first = run * kRunItems;
        add(first, std::min(count, first + kRunItems), partial[static_cast<std::size_t>(run)].value);
    });
    PoseSums total;
    for (const PoseSums& sums : partial) total += sums;
    return total;
}

double Misfit(const PoseSums& sums, double taking_part, double points, double distance_scale_m, double alpha) {
    const double scale2 = distance_scale_m * distance_scale_m;
    double misfit = (1.0 - taking_part / points) * (1.0 + alpha);
    if (sums[L::kDistanceWeight] > 0) misfit += sums[L::kDistanceError] / (sums[L::kDistanceWeight] * scale2);
    if (sums[L::kIntensityWeight] > 0)
        misfit += alpha * sums[L::kIntensityError] / (sums[L::kIntensityWeight] * scale2);
    return misfit;
}

Matrix6d NormalisedHessian(const Matrix6d& hessian, const Eigen::Vector3d& camera_local, double scene_depth_m) {
    const Matrix6d A = FromNormalised(camera_local, scene_depth_m);
    const Matrix6d N = A.transpose() * hessian * A;
    const double trace = N.trace();
    return trace > 0 ? Matrix6d(N / trace) : Matrix6d::Zero();
}

PoseStep SolvePoseStep(const PoseSums& sums, const SolverOptions& options, double gain, double offset,
                     const Eigen::Vector3d& camera_local, double scene_depth_m) {
    PoseStep step;
    Matrix6d H;
    Vector6d g;
    int at = L::kHessian;
    for (int i = 0; i < 6; ++i) {
        for (int j = i; j < 6; ++j, ++at) H(i, j) = H(j, i) = sums[at];
        g(i) = sums[L::kGradient + i];
    }
    // Brightness: eliminated by its Schur complement, so that it takes from the pose what it explains.
    Eigen::Matrix<double, 6, 2> B = Eigen::Matrix<double, 6, 2>::Zero();
    Eigen::Matrix2d C = Eigen::Matrix2d::Identity();
    Eigen::Vector2d h = Eigen::Vector2d::Zero();
    const bool brightness = options.estimate_brightness && sums[L::kBrightness + 2] > 0;
    if (brightness) {
        for (int i = 0; i < 6; ++i) B.row(i) << sums[L::kCoupling + 2 * i], sums[L::kCoupling + 2 * i + 1];
        const double prior = options.brightness_prior;
        C << sums[L::kBrightness] + prior, sums[L::kBrightness + 1], sums[L::kBrightness + 1],
            sums[L::kBrightness + 2] + prior;
        h << sums[L::kBrightnessGradient] + prior * (gain - 1.0), sums[L::kBrightnessGradient + 1] + prior * offset;
        const Eigen::Matrix2d C_inverse = C.inverse();
        H -= B * C_inverse * B.transpose();
        g -= B * C_inverse * h;
    }
    if (!H.allFinite() || !g.allFinite() || H.trace() <= 0) return step;

    // Solve in the normalised coordinates: well scaled, and directions that the scene does not hold can be left alone.
    const Matrix6d A = FromNormalised(camera_local, scene_depth_m);
    const Matrix6d N = A.transpose() * H * A;
    const Vector6d n = A.transpose() * g;
    const Eigen::SelfAdjointEigenSolver<Matrix6d> eigen(N);
    if (eigen.info() != Eigen::Success) return step;
    const Vector6d values = eigen.eigenvalues() / N.trace();
    step.smallest_eigenvalue = values(0);
    const double damping = options.damping * N.trace();
    Vector6d projected = eigen.eigenvectors().transpose() * n;
    Vector6d held = Vector6d::Zero();
    const double least = std::max(options.min_eigenvalue, 1e-12);
    const bool open = values(0) <= (options.last_degenerate ? kHeldAgain : 1.0) * least;
    for (int i = 0; i < 6; ++i) {
        const bool hold = open && values(i) <= kClearlyHeld * least;
        step.held_directions += hold;
        held(i) = hold;
        projected(i) = hold ? 0.0 : -projected(i) / (eigen.eigenvalues()(i) + damping);
    }
    step.increment = A * (eigen.eigenvectors() * projected);
    if (step.held_directions > 0)
        step.held = A * eigen.eigenvectors() * held.asDiagonal() * eigen.eigenvectors().transpose() * A.inverse();
    step.predicted_decrease = -step.increment.dot(2.0 * g + H * step.increment);
    if (brightness) {
        step.predicted_decrease += h.dot(C.inverse() * h);
        const Eigen::Vector2d change = C.inverse() * (-h - B.transpose() * step.increment);
        step.gain_change = change(0);
        step.offset_change = change(1);
    }
    step.valid = step.increment.allFinite();
    return step;
}

Eigen::Isometry3d WithHeldAsExpected(const PoseStep& step, const Eigen::Isometry3d& T_local_camera,
                                     const Eigen::Isometry3d& T_local_camera_expected) {
    if (step.held_directions == 0) return T_local_camera;
    const Vector6d astray = step.held * Se3Log(T_local_camera * T_local_camera_expected.inverse());
    return Normalised(Se3Exp(-astray) * T_local_camera);
}

}  // namespace tessera
