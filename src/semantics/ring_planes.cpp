#include "semantics/ring_planes.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>

namespace tessera {
namespace {

constexpr std::size_t kMostPoints = 900;
constexpr int kMostPlanes = 3, kTrials = 80;
constexpr float kLeastShare = 0.125f;
constexpr std::size_t kLeastPoints = 30;
// Share of a side's points that must lie in the plane for the side to count.
constexpr float kSideShare = 0.25f;
constexpr float kMost = 0.5f;

using Points = std::vector<Eigen::Vector3f>;

bool Contains(const PixelBox& box, int x, int y) {
    return x >= box.x_begin && x < box.x_end && y >= box.y_begin && y < box.y_end;
}

// 0 above, 1 below, 2 left, 3 right of the box.
int SideOf(const PixelBox& box, int x, int y) {
    if (x >= box.x_begin && x < box.x_end) return y < box.y_begin ? 0 : 1;
    return x < box.x_begin ? 2 : 3;
}

struct Ring {
    Points points;
    std::vector<int> sides;  // one per point
};

bool LiesIn(const Plane& plane, const Eigen::Vector3f& p) {
    return std::abs(plane.n.dot(p) - plane.d) < PlaneTolerance_m(p.z());
}

Ring RingPoints(const DepthImage& depth_m, const PinholeCamera& camera, const PixelBox& box,
                const PixelBox& window, std::span<const PixelBox> others) {
    const double area = static_cast<double>(window.width()) * window.height() -
                        static_cast<double>(box.width()) * box.height();
    const int step =
        std::max(1, static_cast<int>(std::sqrt(area / static_cast<double>(kMostPoints))));
    Ring ring;
    for (int y = window.y_begin; y < window.y_end; y += step)
        for (int x = window.x_begin; x < window.x_end; x += step) {
            if (Contains(box, x, y) || depth_m(x, y) <= 0) continue;
            if (std::ranges::any_of(others,
                                    [&](const PixelBox& other) { return Contains(other, x, y); }))
                continue;
            ring.points.push_back(camera.Unproject(x, y, depth_m(x, y)).cast<float>());
            ring.sides.push_back(SideOf(box, x, y));
        }
    return ring;
}

std::size_t CountIn(const Plane& plane, const Points& points) {
    return static_cast<std::size_t>(
        std::ranges::count_if(points, [&](const auto& p) { return LiesIn(plane, p); }));
}

std::optional<Plane> ThroughThree(const Eigen::Vector3f& a, const Eigen::Vector3f& b,
                                  const Eigen::Vector3f& c) {
    const Eigen::Vector3f n = (b - a).cross(c - a);
    const float length = n.norm();
    if (length < 1e-5f) return std::nullopt;
    return Plane{n / length, n.dot(a) / length};
}

// Least-squares plane through the points that lie in `plane`.
Plane Refined(const Plane& plane, const Points& points) {
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    Eigen::Matrix3d second = Eigen::Matrix3d::Zero();
    double count = 0;
    for (const Eigen::Vector3f& point : points) {
        if (!LiesIn(plane, point)) continue;
        const Eigen::Vector3d p = point.cast<double>();
        mean += p;
        second += p * p.transpose();
        ++count;
    }
    if (count < 3) return plane;
    mean /= count;
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(second / count -
                                                                mean * mean.transpose());
    const Eigen::Vector3d n = solver.eigenvectors().col(0);
    return {n.cast<float>(), static_cast<float>(n.dot(mean))};
}

Plane BestPlane(const Points& points, std::uint32_t& random) {
    const auto pick = [&]() -> const Eigen::Vector3f& {
        random = random * 1664525u + 1013904223u;
        return points[(random >> 8) % points.size()];
    };
    Plane best;
    std::size_t most = 0;
    for (int trial = 0; trial < kTrials; ++trial) {
        const Eigen::Vector3f &a = pick(), &b = pick(), &c = pick();
        const auto plane = ThroughThree(a, b, c);
        if (!plane) continue;
        if (const std::size_t count = CountIn(*plane, points); count > most) {
            most = count;
            best = *plane;
        }
    }
    return most > 0 ? Refined(Refined(best, points), points) : best;
}

bool CarriesOrBacks(const Plane& plane, const Ring& ring) {
    float all[4] = {}, in[4] = {}, total = 0;
    for (std::size_t i = 0; i < ring.points.size(); ++i) {
        const auto side = static_cast<std::size_t>(ring.sides[i]);
        ++all[side];
        if (LiesIn(plane, ring.points[i])) ++in[side], ++total;
    }
    int sides = 0;
    for (std::size_t s = 0; s < 4; ++s) sides += all[s] > 0 && in[s] >= kSideShare * all[s];
    return sides >= 2 || total >= kMost * static_cast<float>(ring.points.size());
}

}  // namespace

std::vector<Plane> FindRingPlanes(const DepthImage& depth_m, const PinholeCamera& camera,
                                  const PixelBox& box, const PixelBox& window,
                                  std::span<const PixelBox> others) {
    const Ring ring = RingPoints(depth_m, camera, box, window, others);
    Points points = ring.points;
    const std::size_t least = std::max(
        kLeastPoints, static_cast<std::size_t>(kLeastShare * static_cast<float>(points.size())));
    std::vector<Plane> planes;
    std::uint32_t random = 1;
    int tried = 0;
    while (tried < kMostPlanes && points.size() >= least) {
        const Plane plane = BestPlane(points, random);
        if (CountIn(plane, points) < least) break;
        std::erase_if(points, [&](const auto& p) { return LiesIn(plane, p); });
        if (CarriesOrBacks(plane, ring)) planes.push_back(plane);
        ++tried;
    }
    return planes;
}

}  // namespace tessera
