#include "optimize/self_calibration.h"

#include <ceres/ceres.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "optimize/pose_graph_residual.h"
#include "optimize/pose_node.h"

namespace tessera {
namespace {

constexpr double kLoss = 2.0;  // standard deviations

// Calibration as Ceres holds it: the focal scale's logarithm, and the offset.
using Unknowns = std::array<double, 2>;

Calibration CalibrationOf(const Unknowns& c) { return {std::exp(c[0]), c[1]}; }

// A cell's point; `direction` is of the given camera, z = 1.
template <class T>
Eigen::Matrix<T, 3, 1> PointOf(const Eigen::Vector2d& direction, double depth_m, const T* unknowns) {
    using std::exp;
    const T z = T(depth_m) / (T(1) + unknowns[1] * depth_m);
    const T x_scale = z * exp(-unknowns[0]);
    return {x_scale * direction.x(), x_scale * direction.y(), z};
}

// A structured-light sensor's noise (Nguyen et al. 2012, axial), of a cell's mean.
double Sigma_m(double z) { return 0.001 + 0.0019 * (z - 0.4) * (z - 0.4); }

// A point of one view and the plane about the cell of another view in which it lies.
struct PlanePair {
    int from = 0, to = 0;
    Eigen::Vector2d direction_from, direction_to;
    double depth_from_m = 0, depth_to_m = 0, sigma_m = 0;
    Eigen::Vector3d normal;  // in the camera `to`, held fixed for a round

    template <class T>
    bool operator()(const T* unknowns, const T* q_from, const T* t_from, const T* q_to, const T* t_to, T* residual) const {
        using Quaternion = Eigen::Quaternion<T>;
        using Vector = Eigen::Matrix<T, 3, 1>;
        const Eigen::Map<const Quaternion> a(q_from), b(q_to);
        const Eigen::Map<const Vector> ta(t_from), tb(t_to);
        const Vector world = a * PointOf(direction_from, depth_from_m, unknowns) + ta;
        const Vector off = b.conjugate() * (world - tb) - PointOf(direction_to, depth_to_m, unknowns);
        // As the error of the measured depth that it takes: distances in the world would all be small in a small world.
        const T stretch = T(1) + unknowns[1] * depth_to_m;
        const Vector per_metre = PointOf(direction_to, depth_to_m, unknowns) / (depth_to_m * stretch);
        residual[0] = normal.cast<T>().dot(off) / (normal.cast<T>().dot(per_metre) * sigma_m);
        return true;
    }
};

struct EdgePrior {
    PoseEdge edge;

    template <class T>
    bool operator()(const T* q_from, const T* t_from, const T* q_to, const T* t_to, T* residual) const {
        EdgeResidualOf(edge, q_from, t_from, q_to, t_to, residual);
        return true;
    }
};

// What is known of depth cameras before: a few per cent.
struct UnknownsPrior {
    template <class T>
    bool operator()(const T* unknowns, T* residual) const {
        constexpr double kFocal = 0.03, kOffset_per_m = 0.015;
        residual[0] = unknowns[0] / kFocal;
        residual[1] = unknowns[1] / kOffset_per_m;
        return true;
    }
};

using PairCost = ceres::AutoDiffCostFunction<PlanePair, 1, 2, 4, 3, 4, 3>;
using UnknownsCost = ceres::AutoDiffCostFunction<UnknownsPrior, 2, 2>;
using PriorCost = ceres::AutoDiffCostFunction<EdgePrior, 6, 4, 3, 4, 3>;

class Calibrator {
  public:
    Calibrator(const PinholeCamera& camera, const std::vector<CalibrationView>& views, std::span<const PoseEdge> edges,
               const std::vector<Eigen::Isometry3d>& poses)
        : camera_(CalibrationView::ViewOf(camera)), views_(views), edges_(edges), nodes_(poses.begin(), poses.end()) {}

    Result<CalibrationReport> Run();
    std::vector<Eigen::Isometry3d> Poses() const {
        std::vector<Eigen::Isometry3d> poses;
        for (const PoseNode& node : nodes_) poses.push_back(node.Pose());
        return poses;
    }

  private:
    Eigen::Vector2d Direction(int x, int y) const { return {(x - camera_.cx) / camera_.fx, (y - camera_.cy) / camera_.fy}; }
    std::optional<Eigen::Vector3d> Normal(const DepthImage& depth_m, int x, int y) const;
    void Associate(int from, int to);
    std::optional<PlanePair> Pair(int from, int to, const Eigen::Isometry3d& T_to_from, int x, int y) const;
    void Fill(ceres::Problem& problem);
    double Rms_m() const;
    bool Uncertainty(ceres::Problem& problem, CalibrationReport& report);

    PinholeCamera camera_;
    const std::vector<CalibrationView>& views_;
    std::span<const PoseEdge> edges_;
    std::vector<PoseNode> nodes_;
    std::vector<PlanePair> pairs_;
    Unknowns unknowns_{0, 0};
};

// Of the plane about a cell; nothing at its border, at a depth edge, or where it is seen at a grazing angle.
std::optional<Eigen::Vector3d> Calibrator::Normal(const DepthImage& depth_m, int x, int y) const {
    constexpr double kBend = 0.01, kGrazing = 0.35;
    if (x < 1 || y < 1 || x + 1 >= depth_m.width() || y + 1 >= depth_m.height()) return std::nullopt;
    const double here = depth_m(x, y), left = depth_m(x - 1, y), right = depth_m(x + 1, y), up = depth_m(x, y - 1),
                 down = depth_m(x, y + 1);
    if (here <= 0 || left <= 0 || right <= 0 || up <= 0 || down <= 0) return std::nullopt;
    if (std::abs(left + right - 2 * here) > kBend * here || std::abs(up + down - 2 * here) > kBend * here) return std::nullopt;
    const double* c = unknowns_.data();
    const Eigen::Vector3d along = PointOf(Direction(x + 1, y), right, c) - PointOf(Direction(x - 1, y), left, c);
    const Eigen::Vector3d across = PointOf(Direction(x, y + 1), down, c) - PointOf(Direction(x, y - 1), up, c);
    const Eigen::Vector3d normal = along.cross(across).normalized();
    if (std::abs(normal.dot(PointOf(Direction(x, y), here, c).normalized())) < kGrazing) return std::nullopt;
    return normal;
}

std::optional<PlanePair> Calibrator::Pair(int from, int to, const Eigen::Isometry3d& T_to_from, int x, int y) const {
    constexpr double kFar_m = 0.03, kFarShare = 0.01, kSameNormal = 0.85;
    const DepthImage &a = views_[static_cast<std::size_t>(from)].depth_m(), &b = views_[static_cast<std::size_t>(to)].depth_m();
    const auto normal_from = Normal(a, x, y);
    if (!normal_from) return std::nullopt;
    const Eigen::Vector3d point = T_to_from * PointOf(Direction(x, y), a(x, y), unknowns_.data());
    if (point.z() <= 0) return std::nullopt;
    const double scale = std::exp(unknowns_[0]) / point.z();
    const int u = static_cast<int>(std::lround(camera_.fx * scale * point.x() + camera_.cx));
    const int v = static_cast<int>(std::lround(camera_.fy * scale * point.y() + camera_.cy));
    const auto normal = Normal(b, u, v);
    if (!normal || normal->dot(T_to_from.linear() * *normal_from) < kSameNormal) return std::nullopt;
    const double off_m = normal->dot(point - PointOf(Direction(u, v), b(u, v), unknowns_.data()));
    if (std::abs(off_m) > kFar_m + kFarShare * point.z()) return std::nullopt;
    PlanePair pair{from, to, Direction(x, y), Direction(u, v), a(x, y), b(u, v), 0, *normal};
    pair.sigma_m = std::hypot(Sigma_m(pair.depth_from_m), Sigma_m(pair.depth_to_m));
    return pair;
}

void Calibrator::Associate(int from, int to) {
    constexpr int kStep = 5;  // cells: some five hundred points of a view
    const Eigen::Isometry3d T_to_from = nodes_[static_cast<std::size_t>(to)].Pose().inverse() * nodes_[static_cast<std::size_t>(from)].Pose();
    const DepthImage& depth_m = views_[static_cast<std::size_t>(from)].depth_m();
    for (int y = kStep / 2; y < depth_m.height(); y += kStep)
        for (int x = kStep / 2; x < depth_m.width(); x += kStep)
            if (const auto pair = Pair(from, to, T_to_from, x, y)) pairs_.push_back(*pair);
}

// What tracking says of the poses was found with the calibration that is in question: it holds only where the views do not say.
void Calibrator::Fill(ceres::Problem& problem) {
    constexpr double kDoubt = 10.0;
    const auto block = [&](int i) { return nodes_[static_cast<std::size_t>(i)].q.coeffs().data(); };
    const auto place = [&](int i) { return nodes_[static_cast<std::size_t>(i)].t.data(); };
    for (PoseEdge edge : edges_) {
        edge.sigma_m *= kDoubt;
        edge.sigma_rad *= kDoubt;
        problem.AddResidualBlock(new PriorCost(new EdgePrior{edge}), nullptr, block(edge.from), place(edge.from), block(edge.to),
                                 place(edge.to));
    }
    problem.AddResidualBlock(new UnknownsCost(new UnknownsPrior), nullptr, unknowns_.data());
    for (const PlanePair& p : pairs_)
        problem.AddResidualBlock(new PairCost(new PlanePair(p)), new ceres::CauchyLoss(kLoss), unknowns_.data(), block(p.from),
                                 place(p.from), block(p.to), place(p.to));
    for (int i = 0; i < static_cast<int>(nodes_.size()); ++i)
        if (problem.HasParameterBlock(block(i))) problem.SetManifold(block(i), new ceres::EigenQuaternionManifold);
    problem.SetParameterBlockConstant(block(edges_.front().from));
    problem.SetParameterBlockConstant(place(edges_.front().from));
}

// Median absolute distance, as the standard deviation that it would be of normal errors.
double Calibrator::Rms_m() const {
    std::vector<double> off_m;
    for (const PlanePair& p : pairs_) {
        const PoseNode &a = nodes_[static_cast<std::size_t>(p.from)], &b = nodes_[static_cast<std::size_t>(p.to)];
        double residual = 0;
        p(unknowns_.data(), a.q.coeffs().data(), a.t.data(), b.q.coeffs().data(), b.t.data(), &residual);
        off_m.push_back(std::abs(residual) * p.sigma_m);
    }
    std::ranges::nth_element(off_m, off_m.begin() + static_cast<std::ptrdiff_t>(off_m.size() / 2));
    return 1.4826 * off_m[off_m.size() / 2];
}

// From the normal equations, poses eliminated.
bool Calibrator::Uncertainty(ceres::Problem& problem, CalibrationReport& report) {
    ceres::Problem::EvaluateOptions options;
    options.parameter_blocks.push_back(unknowns_.data());
    std::vector<double*> blocks;
    problem.GetParameterBlocks(&blocks);
    for (double* block : blocks)
        if (block != unknowns_.data() && !problem.IsParameterBlockConstant(block)) options.parameter_blocks.push_back(block);
    std::vector<double> residuals;
    ceres::CRSMatrix jacobian;
    problem.Evaluate(options, nullptr, &residuals, nullptr, &jacobian);
    Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(jacobian.num_cols, jacobian.num_cols);
    double squares = 0;
    for (int row = 0; row < jacobian.num_rows; ++row) {
        const int first = jacobian.rows[static_cast<std::size_t>(row)], last = jacobian.rows[static_cast<std::size_t>(row) + 1];
        for (int i = first; i < last; ++i)
            for (int j = first; j < last; ++j)
                normal(jacobian.cols[static_cast<std::size_t>(i)], jacobian.cols[static_cast<std::size_t>(j)]) +=
                    jacobian.values[static_cast<std::size_t>(i)] * jacobian.values[static_cast<std::size_t>(j)];
        squares += residuals[static_cast<std::size_t>(row)] * residuals[static_cast<std::size_t>(row)];
    }
    const Eigen::Index poses = normal.cols() - 2;
    const Eigen::LDLT<Eigen::MatrixXd> of_poses(normal.bottomRightCorner(poses, poses));
    const Eigen::Matrix2d information =
        normal.topLeftCorner<2, 2>() - normal.topRightCorner(2, poses) * of_poses.solve(normal.bottomLeftCorner(poses, 2));
    const Eigen::Matrix2d covariance = information.inverse() * (squares / std::max(1, jacobian.num_rows - jacobian.num_cols));
    report.focal_sigma = std::sqrt(covariance(0, 0));
    report.offset_sigma_per_m = std::sqrt(covariance(1, 1));
    return covariance.allFinite() && covariance(0, 0) > 0 && covariance(1, 1) > 0;
}

Result<CalibrationReport> Calibrator::Run() {
    constexpr int kRounds = 6, kIterations = 15;
    constexpr std::size_t kLeastPoints = 2000;
    constexpr double kFocalSigma = 0.005, kOffsetSigma_per_m = 0.003, kMostFocal = 0.1, kMostOffset_per_m = 0.05;
    const std::string not_shown = "calibration: the scan does not show it; turn the camera over near and far surfaces";
    CalibrationReport report;
    for (int round = 0; round < kRounds; ++round) {
        pairs_.clear();
        for (const PoseEdge& edge : edges_) {
            Associate(edge.from, edge.to);
            Associate(edge.to, edge.from);
        }
        if (pairs_.size() < kLeastPoints) return Status::Error(not_shown);
        if (round == 0) report.rms_before_m = Rms_m();
        ceres::Problem problem;
        Fill(problem);
        ceres::Solver::Options options;
        options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
        if (ceres::IsSparseLinearAlgebraLibraryTypeAvailable(ceres::EIGEN_SPARSE))
            options.sparse_linear_algebra_library_type = ceres::EIGEN_SPARSE;
        options.max_num_iterations = kIterations;
        options.num_threads = 1;
        options.logging_type = ceres::SILENT;
        ceres::Solver::Summary summary;
        ceres::Solve(options, &problem, &summary);
        if (!summary.IsSolutionUsable()) return Status::Error("calibration: " + summary.message);
        if (round + 1 == kRounds && !Uncertainty(problem, report)) return Status::Error(not_shown);
    }
    report.calibration = CalibrationOf(unknowns_);
    report.points = static_cast<int>(pairs_.size());
    report.rms_after_m = Rms_m();
    if (report.focal_sigma > kFocalSigma || report.offset_sigma_per_m > kOffsetSigma_per_m ||
        std::abs(report.calibration.focal_scale - 1) > kMostFocal ||
        std::abs(report.calibration.disparity_offset_per_m) > kMostOffset_per_m || report.rms_after_m > report.rms_before_m)
        return Status::Error(not_shown);
    return report;
}

}  // namespace

Result<CalibrationReport> RefineCalibration(const PinholeCamera& camera, const std::vector<CalibrationView>& views,
                                            std::span<const PoseEdge> edges, std::vector<Eigen::Isometry3d>& T_world_camera) {
    if (edges.empty()) return Status::Error("calibration: a single view shows nothing; move the camera");
    Calibrator calibrator(camera, views, edges, T_world_camera);
    Result<CalibrationReport> report = calibrator.Run();
    if (report.ok()) T_world_camera = calibrator.Poses();
    return report;
}

}  // namespace tessera
