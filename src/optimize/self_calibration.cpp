#include "optimize/self_calibration.h"

#include <ceres/ceres.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/quantile.h"
#include "optimize/calibration_fit.h"
#include "optimize/calibration_pairs.h"
#include "optimize/pose_graph_residual.h"
#include "optimize/pose_node.h"
#include "optimize/solver_options.h"

namespace tessera {
namespace {

using U = CalibrationUnknowns;

struct UnknownsPrior {
    template <class T>
    bool operator()(const T* unknowns, T* residual) const {
        for (int i = 0; i < U::kCount; ++i)
            residual[i] = unknowns[i] / U::kPrior[static_cast<std::size_t>(i)];
        return true;
    }
};

using PairCost = ceres::AutoDiffCostFunction<PlanePair, 1, U::kCount, 4, 3, 4, 3>;
using UnknownsCost = ceres::AutoDiffCostFunction<UnknownsPrior, U::kCount, U::kCount>;
using PriorCost = ceres::AutoDiffCostFunction<EdgeResidual, 6, 4, 3, 4, 3>;

class Solver {
  public:
    // `solved_for`: the other unknowns stay at 0.
    Solver(const PinholeCamera& camera, const std::vector<CalibrationView>& views,
           std::span<const PoseEdge> edges, const std::vector<Eigen::Isometry3d>& poses,
           const std::array<bool, U::kCount>& solved_for)
        : camera_(camera),
          views_(views),
          edges_(edges),
          solved_for_(solved_for),
          nodes_(poses.begin(), poses.end()) {}

    // Error: too little overlap, or no usable solution.
    Status Run();
    // After that: whether an unknown is clearly not 0.
    bool Shows(U::Index which) const;
    // If all that was solved for is shown, and surfaces fit better, the poses are updated.
    CalibrationReport Report(std::vector<Eigen::Isometry3d>& T_world_camera) const;

  private:
    std::vector<Eigen::Isometry3d> Poses() const {
        std::vector<Eigen::Isometry3d> poses;
        for (const PoseNode& node : nodes_) poses.push_back(node.Pose());
        return poses;
    }
    double* Rotation(int i) { return nodes_[static_cast<std::size_t>(i)].q.coeffs().data(); }
    double* Place(int i) { return nodes_[static_cast<std::size_t>(i)].t.data(); }
    void Fill(ceres::Problem& problem);
    CalibrationFit Linearise(ceres::Problem& problem);
    double Rms_m() const;

    const PinholeCamera camera_;
    const std::vector<CalibrationView>& views_;
    const std::span<const PoseEdge> edges_;
    const std::array<bool, U::kCount> solved_for_;
    std::vector<PoseNode> nodes_;
    std::vector<PlanePair> pairs_;
    CalibrationUnknowns unknowns_;
    std::array<double, U::kCount> sigma_{};  // 0 for unknowns that were not solved for
    double rms_before_m_ = 0;
};

// The tracked poses depend on the given calibration. They get low weight, so that they only decide
// what the views leave open.
void Solver::Fill(ceres::Problem& problem) {
    constexpr double kDoubt = 10.0, kLoss = 2.0;  // standard deviations
    for (PoseEdge edge : edges_) {
        edge.root_information /= kDoubt;
        problem.AddResidualBlock(new PriorCost(new EdgeResidual{edge}), nullptr,
                                 Rotation(edge.from), Place(edge.from), Rotation(edge.to),
                                 Place(edge.to));
    }
    double* unknowns = unknowns_.values.data();
    problem.AddResidualBlock(new UnknownsCost(new UnknownsPrior), nullptr, unknowns);
    for (const PlanePair& p : pairs_)
        problem.AddResidualBlock(new PairCost(new PlanePair(p)), new ceres::CauchyLoss(kLoss),
                                 unknowns, Rotation(p.from), Place(p.from), Rotation(p.to),
                                 Place(p.to));
    for (int i = 0; i < static_cast<int>(nodes_.size()); ++i)
        if (problem.HasParameterBlock(Rotation(i)))
            problem.SetManifold(Rotation(i), new ceres::EigenQuaternionManifold);
    problem.SetParameterBlockConstant(Rotation(edges_.front().from));
    problem.SetParameterBlockConstant(Place(edges_.front().from));
    std::vector<int> fixed;
    for (int i = 0; i < U::kCount; ++i)
        if (!solved_for_[static_cast<std::size_t>(i)]) fixed.push_back(i);
    if (!fixed.empty()) problem.SetManifold(unknowns, new ceres::SubsetManifold(U::kCount, fixed));
}

CalibrationFit Solver::Linearise(ceres::Problem& problem) {
    ceres::Problem::EvaluateOptions options;
    problem.GetResidualBlocks(&options.residual_blocks);  // in the order they were added
    options.parameter_blocks.push_back(unknowns_.values.data());
    for (int i = 0; i < static_cast<int>(nodes_.size()); ++i)
        for (double* block : {Rotation(i), Place(i)})
            if (problem.HasParameterBlock(block) && !problem.IsParameterBlockConstant(block))
                options.parameter_blocks.push_back(block);
    std::vector<double> residuals;
    ceres::CRSMatrix j;
    problem.Evaluate(options, nullptr, &residuals, nullptr, &j);
    std::vector<Eigen::Triplet<double>> entries;
    for (int row = 0; row < j.num_rows; ++row)
        for (int k = j.rows[static_cast<std::size_t>(row)];
             k < j.rows[static_cast<std::size_t>(row) + 1]; ++k)
            entries.emplace_back(row, j.cols[static_cast<std::size_t>(k)],
                                 j.values[static_cast<std::size_t>(k)]);
    CalibrationFit fit;
    fit.jacobian.resize(j.num_rows, j.num_cols);
    fit.jacobian.setFromTriplets(entries.begin(), entries.end());
    fit.residuals = Eigen::Map<const Eigen::VectorXd>(residuals.data(),
                                                      static_cast<Eigen::Index>(residuals.size()));
    fit.pairs = pairs_;
    fit.views = static_cast<int>(nodes_.size());
    fit.unknowns = static_cast<int>(std::ranges::count(solved_for_, true));
    return fit;
}

// Standard deviation from the median absolute distance, for normally distributed errors.
double Solver::Rms_m() const {
    std::vector<double> off_m;
    for (const PlanePair& p : pairs_) {
        const PoseNode &a = nodes_[static_cast<std::size_t>(p.from)],
                       &b = nodes_[static_cast<std::size_t>(p.to)];
        double residual = 0;
        p(unknowns_.values.data(), a.q.coeffs().data(), a.t.data(), b.q.coeffs().data(), b.t.data(),
          &residual);
        off_m.push_back(std::abs(residual) * p.sigma_m);
    }
    return 1.4826 * Median(off_m);
}

Status Solve(ceres::Problem& problem) {
    constexpr int kIterations = 5;  // before the pairs are searched again
    ceres::Solver::Summary summary;
    ceres::Solve(SparseSolverOptions(kIterations), &problem, &summary);
    return summary.IsSolutionUsable() ? Status::Ok()
                                      : Status::Error("calibration: " + summary.message);
}

Status Solver::Run() {
    constexpr int kRounds = 6;
    constexpr std::size_t kFewestPairs = 2000;
    for (int round = 0; round < kRounds; ++round) {
        pairs_ = FindPlanePairs(camera_, views_, edges_, Poses(), unknowns_);
        if (pairs_.size() < kFewestPairs)
            return Status::Error(
                "calibration: keeping the given values, too little was seen from two places");
        if (round == 0) rms_before_m_ = Rms_m();
        ceres::Problem problem;
        Fill(problem);
        if (Status status = Solve(problem); !status.ok()) return status;
        if (round + 1 < kRounds) continue;
        const Eigen::VectorXd sigma = Deviations(Linearise(problem));
        for (std::size_t k = 0, at = 0; k < solved_for_.size(); ++k)
            if (solved_for_[k]) sigma_[k] = sigma(static_cast<Eigen::Index>(at++));
    }
    return Status::Ok();
}

bool Solver::Shows(U::Index which) const {
    constexpr double kSigmas = 5;  // jackknifes over few parts have wide tails
    // Largest errors of real depth cameras; larger estimates have another cause.
    constexpr double kMost[] = {0.1, 0.03};
    const double value = std::abs(unknowns_.values[which]);
    return value > kSigmas * sigma_[which] && value < kMost[which];
}

CalibrationReport Solver::Report(std::vector<Eigen::Isometry3d>& T_world_camera) const {
    CalibrationReport report;
    report.calibration = {std::exp(unknowns_.values[U::kLogFocal]), unknowns_.values[U::kOffset]};
    report.focal_sigma = sigma_[U::kLogFocal];
    report.offset_sigma_per_m = sigma_[U::kOffset];
    report.rms_before_m = rms_before_m_;
    report.rms_after_m = Rms_m();
    report.points = static_cast<int>(pairs_.size());
    report.shown = report.rms_after_m < report.rms_before_m;
    for (const U::Index which : {U::kLogFocal, U::kOffset})
        report.shown = report.shown && (!solved_for_[which] || Shows(which));
    if (report.shown) T_world_camera = Poses();
    return report;
}

}  // namespace

Result<CalibrationReport> RefineCalibration(const PinholeCamera& camera,
                                            const std::vector<CalibrationView>& views,
                                            std::span<const PoseEdge> edges,
                                            std::vector<Eigen::Isometry3d>& T_world_camera) {
    if (edges.empty())
        return Status::Error(
            "calibration: keeping the given values, a single keyframe is not enough");
    Solver both(camera, views, edges, T_world_camera, {true, true});
    if (Status solved = both.Run(); !solved.ok()) return solved;
    const bool offset = both.Shows(U::kOffset), focal = both.Shows(U::kLogFocal);
    if (offset && focal) return both.Report(T_world_camera);
    Solver one(camera, views, edges, T_world_camera, {!offset, offset});
    if (Status solved = one.Run(); !solved.ok()) return solved;
    return one.Report(T_world_camera);
}

}  // namespace tessera
