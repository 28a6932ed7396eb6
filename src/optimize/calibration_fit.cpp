#include "optimize/calibration_fit.h"

#include <Eigen/SparseCholesky>
#include <algorithm>

namespace tessera {
namespace {

using Sparse = Eigen::SparseMatrix<double>;
using SparseRows = Eigen::SparseMatrix<double, Eigen::RowMajor>;

struct NormalEquations {
    Sparse matrix;
    Eigen::VectorXd gradient;
};

NormalEquations NormalOf(const CalibrationFit& fit, const std::vector<Eigen::Index>& rows) {
    std::vector<Eigen::Triplet<double>> entries;
    Eigen::VectorXd residuals(static_cast<Eigen::Index>(rows.size()));
    for (std::size_t i = 0; i < rows.size(); ++i) {
        residuals(static_cast<Eigen::Index>(i)) = fit.residuals(rows[i]);
        for (SparseRows::InnerIterator it(fit.jacobian, rows[i]); it; ++it)
            entries.emplace_back(static_cast<int>(i), static_cast<int>(it.col()), it.value());
    }
    Sparse part(static_cast<Eigen::Index>(rows.size()), fit.jacobian.cols());
    part.setFromTriplets(entries.begin(), entries.end());
    return {Sparse(part.transpose()) * part, part.transpose() * residuals};
}

std::vector<int> Times(const CalibrationFit& fit, int parts) {
    std::vector<int> part;
    for (const PlanePair& p : fit.pairs)
        part.push_back(std::max(p.from, p.to) * parts / std::max(1, fit.views));
    return part;
}

// Splits the pairs into parts of equal size by the rank of their key.
template <class KeyOf>
std::vector<int> Ranks(const CalibrationFit& fit, int parts, const KeyOf& key_of) {
    std::vector<double> sorted;
    for (const PlanePair& p : fit.pairs) sorted.push_back(key_of(p));
    std::ranges::sort(sorted);
    std::vector<int> part;
    for (const PlanePair& p : fit.pairs) {
        const auto rank = std::ranges::lower_bound(sorted, key_of(p)) - sorted.begin();
        part.push_back(static_cast<int>(rank * parts / static_cast<std::ptrdiff_t>(sorted.size())));
    }
    return part;
}

std::vector<int> Quarters(const CalibrationFit& fit) {
    std::vector<int> part;
    for (const PlanePair& p : fit.pairs)
        part.push_back((p.direction_to.x() > 0 ? 1 : 0) + (p.direction_to.y() > 0 ? 2 : 0));
    return part;
}

Eigen::VectorXd ScatterVariance(const CalibrationFit& fit) {
    const Sparse jacobian(fit.jacobian);
    const Sparse normal = Sparse(jacobian.transpose()) * jacobian;
    const Eigen::SimplicialLDLT<Sparse> solver(normal);
    const auto spare = std::max<Eigen::Index>(1, jacobian.rows() - jacobian.cols());
    const double scatter = fit.residuals.squaredNorm() / static_cast<double>(spare);
    Eigen::VectorXd variance(fit.unknowns);
    for (Eigen::Index i = 0; i < fit.unknowns; ++i)
        variance(i) = scatter * solver.solve(Eigen::VectorXd::Unit(jacobian.cols(), i))(i);
    return variance;
}

}  // namespace

Eigen::VectorXd JackknifeSpread(const CalibrationFit& fit, const std::vector<int>& part,
                                int parts) {
    const Eigen::Index priors = fit.jacobian.rows() - static_cast<Eigen::Index>(fit.pairs.size());
    // The last entry holds the prior rows, which are never left out.
    std::vector<std::vector<Eigen::Index>> rows(static_cast<std::size_t>(parts) + 1);
    for (Eigen::Index i = 0; i < priors; ++i) rows.back().push_back(i);
    for (std::size_t i = 0; i < part.size(); ++i)
        rows[static_cast<std::size_t>(part[i])].push_back(priors + static_cast<Eigen::Index>(i));
    std::vector<NormalEquations> normals;
    for (const auto& r : rows) normals.push_back(NormalOf(fit, r));
    NormalEquations whole = normals.back();
    for (int i = 0; i < parts; ++i) {
        whole.matrix += normals[static_cast<std::size_t>(i)].matrix;
        whole.gradient += normals[static_cast<std::size_t>(i)].gradient;
    }
    Eigen::MatrixXd changes(fit.unknowns, parts);
    for (int i = 0; i < parts; ++i) {
        const NormalEquations& out = normals[static_cast<std::size_t>(i)];
        const Eigen::SimplicialLDLT<Sparse> solver(Sparse(whole.matrix - out.matrix));
        changes.col(i) = solver.solve(out.gradient - whole.gradient).head(fit.unknowns);
    }
    const Eigen::VectorXd mean = changes.rowwise().mean();
    return ((changes.colwise() - mean).rowwise().squaredNorm() * (parts - 1.0) / parts).cwiseSqrt();
}

Eigen::VectorXd Deviations(const CalibrationFit& fit) {
    constexpr int kTimes = 8, kDistances = 3, kRings = 3, kQuarters = 4;
    Eigen::VectorXd variance = ScatterVariance(fit);
    const auto add = [&](const std::vector<int>& part, int parts) {
        variance += JackknifeSpread(fit, part, parts).cwiseAbs2();
    };
    add(Times(fit, kTimes), kTimes);
    add(Ranks(fit, kDistances, [](const PlanePair& p) { return p.depth_to_m; }), kDistances);
    add(Ranks(fit, kRings, [](const PlanePair& p) { return p.direction_to.squaredNorm(); }),
        kRings);
    add(Quarters(fit), kQuarters);
    return variance.cwiseSqrt();
}

}  // namespace tessera
