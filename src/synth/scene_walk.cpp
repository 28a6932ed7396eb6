// A long walk through the flat's rooms, for loop closure: three rounds that close at different
// times, the second the other way round, and a turn within a room between them.
#include <cmath>
#include <numbers>

#include "synth/builtin_scenes.h"
#include "synth/interiors.h"

namespace tessera {
namespace {

using Way = std::vector<Eigen::Vector2d>;

void Append(const Way& more, Way& way) { way.insert(way.end(), more.begin(), more.end()); }

Way WalkPoints() {
    const Way there = {{5.9, 1.35}, {7.9, 1.25}, {11.1, 1.55}, {12.1, 3.05}, {11.4, 4.55},
                       {8.1, 4.55}, {6.4, 4.75}, {3.4, 4.8},   {1.4, 4.6},   {1.4, 2.25}},
              // Into the room's far corner and back, so that the next round goes the other way.
        turn = {{2.6, 1.5}, {3.3, 2.0}, {2.9, 3.0}, {1.5, 3.4}, {1.9, 4.5}},
              back = {{3.5, 4.75}, {6.5, 4.7}, {8.2, 4.5}, {11.5, 4.5}, {12.2, 3.0}, {11.2, 1.5},
                      {8.0, 1.2},  {6.0, 1.3}, {3.1, 1.4}, {1.5, 2.2},  {1.5, 4.4},  {3.2, 4.7},
                      {5.4, 4.6},  {5.6, 4.4}, {3.6, 4.3}, {2.9, 3.2},  {1.7, 2.5},  {2.2, 1.5}};
    Way way = {{3.0, 1.4}};
    for (const Way* part : {&there, &turn, &back, &there}) Append(*part, way);
    Append({{2.9, 1.45}, {5.5, 1.3}}, way);
    return way;
}

// Points along a Catmull-Rom curve through the given ones, `step_m` apart.
Way EvenlyAlong(const Way& points, double step_m) {
    constexpr int kFine = 400;
    Way even = {points.front()};
    Eigen::Vector2d last = points.front();
    double left_m = step_m;
    for (std::size_t i = 0; i + 1 < points.size(); ++i) {
        const Eigen::Vector2d &b = points[i], &c = points[i + 1];
        const Eigen::Vector2d &a = i > 0 ? points[i - 1] : b,
                              &d = i + 2 < points.size() ? points[i + 2] : c;
        for (int k = 1; k <= kFine; ++k) {
            const double t = static_cast<double>(k) / kFine;
            const Eigen::Vector2d p =
                0.5 * (2 * b + (c - a) * t + (2 * a - 5 * b + 4 * c - d) * t * t +
                       (3 * b - a - 3 * c + d) * t * t * t);
            const double piece_m = (p - last).norm();
            for (left_m -= piece_m; left_m <= 0; left_m += step_m)
                even.push_back(p + left_m / piece_m * (p - last));
            last = p;
        }
    }
    return even;
}

// The heading along the way, which turns by at most `most` from one point to the next.
std::vector<double> HeadingsAlong(const Way& way, double most) {
    constexpr int kAround = 15;  // points before and after
    std::vector<double> headings;
    const int count = static_cast<int>(way.size());
    for (int i = 0; i < count; ++i) {
        const Eigen::Vector2d along =
            way[static_cast<std::size_t>(std::min(i + kAround, count - 1))] -
            way[static_cast<std::size_t>(std::max(i - kAround, 0))];
        const double wanted = std::atan2(along.y(), along.x());
        const double last = headings.empty() ? wanted : headings.back();
        headings.push_back(
            last + std::clamp(std::remainder(wanted - last, 2 * std::numbers::pi), -most, most));
    }
    return headings;
}

}  // namespace

StagedScene MakeWalk() {
    constexpr double kPace_m_s = 0.8, kStep_s = 1 / 30.0, kMostTurn_rad_s = 0.9;
    auto scene = std::make_unique<AnalyticScene>();
    Furnisher add(*scene);
    AddFlat(add);
    scene->Finish(FlatLighting());
    StagedScene staged;
    staged.scene = std::move(scene);
    staged.description = "the flat, walked through three times, in both directions";
    const Way way = EvenlyAlong(WalkPoints(), kPace_m_s * kStep_s);
    const std::vector<double> headings = HeadingsAlong(way, kMostTurn_rad_s * kStep_s);
    staged.path.duration_s = static_cast<double>(way.size() - 1) * kStep_s;
    staged.path.T_world_camera = [way, headings](double t) {
        const double at = std::clamp(t / kStep_s, 0.0, static_cast<double>(way.size() - 1));
        const std::size_t i = std::min(static_cast<std::size_t>(at), way.size() - 2);
        const double share = at - static_cast<double>(i);
        const Eigen::Vector2d p = way[i] + share * (way[i + 1] - way[i]);
        const double heading = headings[i] + share * (headings[i + 1] - headings[i]);
        const Eigen::Vector3d eye(p.x(), p.y(), 1.42 + 0.03 * std::sin(2.3 * t));
        const double yaw = heading + 0.5 * std::sin(0.8 * t),
                     pitch = -0.25 + 0.12 * std::sin(0.5 * t);
        return Eigen::Isometry3d(
            LookAt(eye, eye + Eigen::Vector3d(std::cos(yaw), std::sin(yaw), pitch)) * Tremor(t));
    };
    return staged;
}

}  // namespace tessera
