#include "optimize/calibration_solver.h"

#include <ceres/ceres.h>

#include <algorithm>

#include "core/quantile.h"
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
    Solver(const CalibrationProblem& problem, const std::vector<Eigen::Isometry3d>& poses,
           const CalibrationMask& mask)
        : problem_(problem), mask_(mask), nodes_(poses.begin(), poses.end()) {}

    Result<CalibrationEstimate> Run();

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

    const CalibrationProblem& problem_;
    CalibrationMask mask_;
    std::vector<PoseNode> nodes_;
    std::vector<PlanePair> pairs_;
    CalibrationUnknowns unknowns_;
};

// The tracked poses depend on the given calibration. They get low weight, so that they only decide
// what the views leave open.
void Solver::Fill(ceres::Problem& problem) {
    constexpr double kDoubt = 10.0, kLoss = 2.0;  // standard deviations
    for (PoseEdge edge : problem_.edges) {
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
    problem.SetParameterBlockConstant(Rotation(problem_.edges.front().from));
    problem.SetParameterBlockConstant(Place(problem_.edges.front().from));
    std::vector<int> fixed;
    for (int i = 0; i < U::kCount; ++i)
        if (!mask_[static_cast<std::size_t>(i)]) fixed.push_back(i);
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
    fit.unknowns = static_cast<int>(std::ranges::count(mask_, true));
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

Result<CalibrationEstimate> Solver::Run() {
    constexpr int kRounds = 6;
    constexpr std::size_t kFewestPairs = 2000;
    CalibrationEstimate estimate;
    for (int round = 0; round < kRounds; ++round) {
        pairs_ =
            FindPlanePairs(problem_.camera, problem_.views, problem_.edges, Poses(), unknowns_);
        if (pairs_.size() < kFewestPairs)
            return Status::Error(
                "calibration: keeping the given values, too little was seen from two places");
        if (round == 0) estimate.rms_before_m = Rms_m();
        ceres::Problem problem;
        Fill(problem);
        if (Status status = Solve(problem); !status.ok()) return status;
        if (round + 1 < kRounds) continue;
        const Eigen::VectorXd sigma = Deviations(Linearise(problem));
        for (std::size_t k = 0, at = 0; k < mask_.size(); ++k)
            if (mask_[k]) estimate.sigma[k] = sigma(static_cast<Eigen::Index>(at++));
    }
    estimate.unknowns = unknowns_;
    estimate.T_world_camera = Poses();
    estimate.points = static_cast<int>(pairs_.size());
    estimate.rms_m = Rms_m();
    return estimate;
}

}  // namespace

Result<CalibrationEstimate> SolveCalibration(const CalibrationProblem& problem,
                                             const std::vector<Eigen::Isometry3d>& T_world_camera,
                                             const CalibrationMask& mask) {
    if (problem.edges.empty())
        return Status::Error(
            "calibration: keeping the given values, a single keyframe is not enough");
    return Solver(problem, T_world_camera, mask).Run();
}

}  // namespace tessera
