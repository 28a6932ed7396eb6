#include "optimize/pose_graph.h"

#include <ceres/ceres.h>

#include <algorithm>

#include "core/check.h"
#include "optimize/pose_graph_residual.h"
#include "optimize/pose_node.h"
#include "optimize/solver_options.h"

namespace tessera {
namespace {

struct EdgeFunctor {
    PoseEdge edge;

    template <class T>
    bool operator()(const T* q_from, const T* t_from, const T* q_to, const T* t_to,
                    T* residual) const {
        EdgeResidualOf(edge, q_from, t_from, q_to, t_to, residual);
        return true;
    }
};

using EdgeCost = ceres::AutoDiffCostFunction<EdgeFunctor, 6, 4, 3, 4, 3>;

}  // namespace

bool PoseGraphAvailable() { return true; }

Result<PoseGraphReport> OptimisePoses(std::span<const PoseEdge> edges,
                                      std::vector<Eigen::Isometry3d>& T_world_camera) {
    constexpr int kMaxIterations = 50;
    // Standard deviations at which the loss starts to reduce an edge's weight.
    constexpr double kLoss = 3.0;
    std::vector<PoseNode> nodes(T_world_camera.begin(), T_world_camera.end());
    std::vector<bool> used(nodes.size(), false);
    ceres::Problem problem;
    for (const PoseEdge& edge : edges) {
        TESSERA_CHECK(std::min(edge.from, edge.to) >= 0 &&
                          std::max(edge.from, edge.to) < static_cast<int>(nodes.size()),
                      "an edge from {} to {} among {} poses", edge.from, edge.to, nodes.size());
        const auto from = static_cast<std::size_t>(edge.from),
                   to = static_cast<std::size_t>(edge.to);
        problem.AddResidualBlock(new EdgeCost(new EdgeFunctor{edge}), new ceres::CauchyLoss(kLoss),
                                 nodes[from].q.coeffs().data(), nodes[from].t.data(),
                                 nodes[to].q.coeffs().data(), nodes[to].t.data());
        used[from] = used[to] = true;
    }
    for (std::size_t i = 0; i < nodes.size(); ++i)
        if (used[i])
            problem.SetManifold(nodes[i].q.coeffs().data(), new ceres::EigenQuaternionManifold);
    if (edges.empty()) return PoseGraphReport{};
    const std::size_t fixed =
        static_cast<std::size_t>(std::ranges::find(used, true) - used.begin());
    problem.SetParameterBlockConstant(nodes[fixed].q.coeffs().data());
    problem.SetParameterBlockConstant(nodes[fixed].t.data());

    ceres::Solver::Options options = SparseSolverOptions(kMaxIterations);
    options.function_tolerance = 1e-9;
    ceres::Solver::Summary summary;
    ceres::Solve(options, &problem, &summary);
    if (!summary.IsSolutionUsable())
        return Status::Error("the pose graph could not be solved: " + summary.message);
    for (std::size_t i = 0; i < nodes.size(); ++i)
        if (used[i] && i != fixed) T_world_camera[i] = nodes[i].Pose();
    return PoseGraphReport{static_cast<int>(summary.iterations.size()) - 1, summary.initial_cost,
                           summary.final_cost};
}

double EdgeJacobianError(const PoseEdge& edge, const Eigen::Isometry3d& T_world_from,
                         const Eigen::Isometry3d& T_world_to) {
    constexpr double kDifference = 1e-6;
    PoseNode from(T_world_from), to(T_world_to);
    double* blocks[] = {from.q.coeffs().data(), from.t.data(), to.q.coeffs().data(), to.t.data()};
    const int sizes[] = {4, 3, 4, 3};
    double jacobian[4][24];
    double* jacobians[] = {jacobian[0], jacobian[1], jacobian[2], jacobian[3]};
    Vector6d residual;
    EdgeCost(new EdgeFunctor{edge}).Evaluate(blocks, residual.data(), jacobians);
    double largest = 0, error = 0;
    for (int block = 0; block < 4; ++block)
        for (int k = 0; k < sizes[block]; ++k) {
            const double value = blocks[block][k];
            Vector6d sides[2];
            for (int side = 0; side < 2; ++side) {
                blocks[block][k] = value + (side == 0 ? kDifference : -kDifference);
                EdgeResidualOf(edge, blocks[0], blocks[1], blocks[2], blocks[3],
                               sides[side].data());
            }
            blocks[block][k] = value;
            for (int row = 0; row < 6; ++row) {
                const double exact = jacobian[block][row * sizes[block] + k];
                largest = std::max(largest, std::abs(exact));
                error = std::max(
                    error, std::abs(exact - (sides[0](row) - sides[1](row)) / (2 * kDifference)));
            }
        }
    return error / largest;
}

}  // namespace tessera
