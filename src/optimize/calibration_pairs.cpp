#include "optimize/calibration_pairs.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <optional>

namespace tessera {
namespace {

// Axial noise of a structured-light sensor (Nguyen et al. 2012), for the mean of a cell.
double Sigma_m(double z) { return 0.001 + 0.0019 * (z - 0.4) * (z - 0.4); }

class PairFinder {
  public:
    PairFinder(const PinholeCamera& camera, const CalibrationUnknowns& unknowns)
        : camera_(camera), unknowns_(unknowns) {}

    std::optional<PlanePair> Find(const DepthImage& from, const DepthImage& to,
                                  const Eigen::Isometry3d& T_to_from, int x, int y) const;

  private:
    Eigen::Vector2d Direction(int x, int y) const {
        return {(x - camera_.cx) / camera_.fx, (y - camera_.cy) / camera_.fy};
    }
    Eigen::Vector3d Point(const DepthImage& depth_m, int x, int y) const {
        return CalibratedPoint(Direction(x, y), depth_m(x, y), unknowns_.values.data());
    }
    std::optional<Eigen::Vector3d> Normal(const DepthImage& depth_m, int x, int y) const;
    Eigen::Vector2i Cell(const Eigen::Vector3d& point) const;

    PinholeCamera camera_;  // camera of the reduced views
    const CalibrationUnknowns& unknowns_;
};

// Normal of the plane around a cell. None at the image border, at a depth discontinuity or at
// grazing angles.
std::optional<Eigen::Vector3d> PairFinder::Normal(const DepthImage& depth_m, int x, int y) const {
    constexpr double kBend = 0.01, kGrazing = 0.35;
    if (x < 1 || y < 1 || x + 1 >= depth_m.width() || y + 1 >= depth_m.height())
        return std::nullopt;
    const double here = depth_m(x, y), left = depth_m(x - 1, y), right = depth_m(x + 1, y),
                 up = depth_m(x, y - 1), down = depth_m(x, y + 1);
    if (here <= 0 || left <= 0 || right <= 0 || up <= 0 || down <= 0) return std::nullopt;
    if (std::abs(left + right - 2 * here) > kBend * here ||
        std::abs(up + down - 2 * here) > kBend * here)
        return std::nullopt;
    const Eigen::Vector3d along = Point(depth_m, x + 1, y) - Point(depth_m, x - 1, y);
    const Eigen::Vector3d across = Point(depth_m, x, y + 1) - Point(depth_m, x, y - 1);
    const Eigen::Vector3d normal = along.cross(across).normalized();
    if (std::abs(normal.dot(Point(depth_m, x, y).normalized())) < kGrazing) return std::nullopt;
    return normal;
}

// Returns the cell that sees a point.
Eigen::Vector2i PairFinder::Cell(const Eigen::Vector3d& point) const {
    const double scale = std::exp(unknowns_.values[CalibrationUnknowns::kLogFocal]) / point.z();
    return {static_cast<int>(std::lround(camera_.fx * scale * point.x() + camera_.cx)),
            static_cast<int>(std::lround(camera_.fy * scale * point.y() + camera_.cy))};
}

std::optional<PlanePair> PairFinder::Find(const DepthImage& from, const DepthImage& to,
                                          const Eigen::Isometry3d& T_to_from, int x, int y) const {
    constexpr double kFar_m = 0.03, kFarShare = 0.01, kSameNormal = 0.85;
    const auto normal_from = Normal(from, x, y);
    if (!normal_from) return std::nullopt;
    const Eigen::Vector3d point = T_to_from * Point(from, x, y);
    if (point.z() <= 0) return std::nullopt;
    const Eigen::Vector2i cell = Cell(point);
    const auto normal = Normal(to, cell.x(), cell.y());
    if (!normal || normal->dot(T_to_from.linear() * *normal_from) < kSameNormal)
        return std::nullopt;
    const double off_m = normal->dot(point - Point(to, cell.x(), cell.y()));
    if (std::abs(off_m) > kFar_m + kFarShare * point.z()) return std::nullopt;
    const double z_from = from(x, y), z_to = to(cell.x(), cell.y());
    return PlanePair{0,
                     0,
                     Direction(x, y),
                     Direction(cell.x(), cell.y()),
                     z_from,
                     z_to,
                     std::hypot(Sigma_m(z_from), Sigma_m(z_to)),
                     *normal};
}

// True if the surface normals constrain the relative motion of two views in every direction. If all
// surfaces lie in one plane, the tracked poses would determine the calibration.
bool ConstrainsMotion(std::span<const PlanePair> pairs) {
    // Smallest eigenvalue of the normals' scatter matrix, per pair.
    constexpr double kLeastShare = 0.02;
    Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
    for (const PlanePair& p : pairs) squares += p.normal * p.normal.transpose();
    const double least =
        Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(squares, Eigen::EigenvaluesOnly)
            .eigenvalues()(0);
    return least >= kLeastShare * static_cast<double>(pairs.size());
}

}  // namespace

std::vector<PlanePair> FindPlanePairs(const PinholeCamera& camera,
                                      const std::vector<CalibrationView>& views,
                                      std::span<const PoseEdge> edges,
                                      std::span<const Eigen::Isometry3d> T_world_camera,
                                      const CalibrationUnknowns& unknowns) {
    constexpr int kStep = 5;  // cells; yields about 500 points per view
    const PairFinder finder(CalibrationView::ViewOf(camera), unknowns);
    std::vector<PlanePair> pairs;
    const auto one_way = [&](int from, int to) {
        const auto a = static_cast<std::size_t>(from), b = static_cast<std::size_t>(to);
        const Eigen::Isometry3d T_to_from = T_world_camera[b].inverse() * T_world_camera[a];
        const DepthImage& depth_m = views[a].depth_m();
        for (int y = kStep / 2; y < depth_m.height(); y += kStep)
            for (int x = kStep / 2; x < depth_m.width(); x += kStep)
                if (auto pair = finder.Find(depth_m, views[b].depth_m(), T_to_from, x, y)) {
                    pair->from = from;
                    pair->to = to;
                    pairs.push_back(*pair);
                }
    };
    for (const PoseEdge& edge : edges) {
        const std::size_t first = pairs.size();
        one_way(edge.from, edge.to);
        one_way(edge.to, edge.from);
        if (!ConstrainsMotion(std::span(pairs).subspan(first))) pairs.resize(first);
    }
    return pairs;
}

}  // namespace tessera
