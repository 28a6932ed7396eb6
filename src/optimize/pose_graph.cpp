#include "optimize/pose_graph.h"

#include <ceres/ceres.h>

#include <algorithm>

#include "core/check.h"
#include "optimize/pose_graph_residual.h"
#include "optimize/pose_node.h"
#include "optimize/solver_options.h"

namespace tessera {
namespace {

using EdgeCost = ceres::AutoDiffCostFunction<EdgeResidual, 6, 4, 3, 4, 3>;

}  // namespace

bool PoseGraphAvailable() { return true; }

Status OptimisePoses(std::span<const PoseEdge> edges,
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
        problem.AddResidualBlock(new EdgeCost(new EdgeResidual{edge}), new ceres::CauchyLoss(kLoss),
                                 nodes[from].q.coeffs().data(), nodes[from].t.data(),
                                 nodes[to].q.coeffs().data(), nodes[to].t.data());
        used[from] = used[to] = true;
    }
    for (std::size_t i = 0; i < nodes.size(); ++i)
        if (used[i])
            problem.SetManifold(nodes[i].q.coeffs().data(), new ceres::EigenQuaternionManifold);
    if (edges.empty()) return Status::Ok();
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
    return Status::Ok();
}

}  // namespace tessera
