#include "optimize/self_calibration.h"

#include <cmath>

#include "optimize/calibration_solver.h"

namespace tessera {
namespace {

using U = CalibrationUnknowns;

bool Shown(const CalibrationEstimate& estimate, U::Index which) {
    constexpr double kSigmas = 5;  // jackknifes over few parts have wide tails
    // Largest errors of real depth cameras; larger estimates have another cause.
    constexpr double kMost[] = {0.1, 0.03};
    const double value = std::abs(estimate.unknowns.values[which]);
    return value > kSigmas * estimate.sigma[which] && value < kMost[which];
}

CalibrationReport ReportOf(const CalibrationEstimate& estimate, bool shown) {
    CalibrationReport report;
    report.shown = shown && estimate.rms_m < estimate.rms_before_m;
    report.calibration = {std::exp(estimate.unknowns.values[U::kLogFocal]),
                          estimate.unknowns.values[U::kOffset]};
    report.focal_sigma = estimate.sigma[U::kLogFocal];
    report.offset_sigma_per_m = estimate.sigma[U::kOffset];
    report.rms_before_m = estimate.rms_before_m;
    report.rms_after_m = estimate.rms_m;
    report.points = estimate.points;
    return report;
}

}  // namespace

Result<CalibrationReport> RefineCalibration(const PinholeCamera& camera,
                                            const std::vector<CalibrationView>& views,
                                            std::span<const PoseEdge> edges,
                                            std::vector<Eigen::Isometry3d>& T_world_camera) {
    const CalibrationProblem problem{camera, views, edges};
    Result<CalibrationEstimate> estimate = SolveCalibration(problem, T_world_camera, {true, true});
    if (!estimate.ok()) return estimate.status();
    const bool offset = Shown(estimate.value(), U::kOffset);
    bool shown = offset && Shown(estimate.value(), U::kLogFocal);
    if (!shown) {
        estimate = SolveCalibration(problem, T_world_camera, {!offset, offset});
        if (!estimate.ok()) return estimate.status();
        shown = Shown(estimate.value(), offset ? U::kOffset : U::kLogFocal);
    }
    const CalibrationReport report = ReportOf(estimate.value(), shown);
    if (report.shown) T_world_camera = std::move(estimate.value().T_world_camera);
    return report;
}

}  // namespace tessera
