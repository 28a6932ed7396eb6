// Baked light: soft shadows and the share of open sky, computed once for a grid over each chart.
#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "synth/analytic_scene.h"
#include "synth/hash_random.h"

namespace tessera {
namespace {

constexpr int kLightRays = 16;  // towards each light
constexpr int kSkyRays = 32;
constexpr double kSkyReach = 0.8;  // what is farther away does not darken, metres
constexpr int kMaxLights = 3;      // the strongest at a point; the others are too far to matter
constexpr double kLiftOff = 1e-4;  // metres: shadow rays start above their own surface

// Even over the unit ball's surface.
Eigen::Vector3d DirectionFrom(std::uint64_t bits) {
    const double z = 2.0 * static_cast<double>(bits & 0xffffffff) / 4294967296.0 - 1.0;
    const double angle = 2.0 * std::numbers::pi * static_cast<double>(bits >> 32) / 4294967296.0;
    const double r = std::sqrt(std::max(1 - z * z, 0.0));
    return {r * std::cos(angle), r * std::sin(angle), z};
}

double Unshaded(const Light& light, const Eigen::Vector3d& p, const Eigen::Vector3d& normal) {
    const Eigen::Vector3d to_light = light.p_world - p;
    const double distance2 = std::max(to_light.squaredNorm(), 0.25);
    return light.intensity * std::max(normal.dot(to_light), 0.0) / (std::sqrt(distance2) * distance2);
}

}  // namespace

bool AnalyticScene::Occluded(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                             double length) const {
    for (const Part& part : parts_) {
        const Eigen::Vector3d to_centre = part.shape.T_world_shape.translation() - origin;
        const double along = to_centre.dot(direction);
        if (along < -part.radius_m || along > length + part.radius_m) continue;
        if (to_centre.squaredNorm() - along * along > part.radius_m * part.radius_m) continue;
        if (Intersect(part.shape, part.T_shape_world * origin, part.T_shape_world.linear() * direction, length))
            return true;
    }
    return false;
}

double AnalyticScene::Irradiance(const Lighting& lighting, const Eigen::Vector3d& p,
                                 const Eigen::Vector3d& normal, std::uint64_t key) const {
    const Eigen::Vector3d origin = p + kLiftOff * normal;
    std::uint64_t counter = 0;
    int open = 0;
    for (int i = 0; i < kSkyRays; ++i) {
        // A point of the unit ball's surface added to the normal: cosine-weighted directions.
        const Eigen::Vector3d d = (normal * 1.0001 + DirectionFrom(MixBits(key + counter++))).normalized();
        if (!Occluded(origin, d, kSkyReach)) ++open;
    }
    std::vector<std::pair<double, const Light*>> strongest;
    for (const Light& light : lighting.lights) strongest.emplace_back(Unshaded(light, p, normal), &light);
    std::stable_sort(strongest.begin(), strongest.end(),
                     [](const auto& a, const auto& b) { return a.first > b.first; });
    strongest.resize(std::min<std::size_t>(strongest.size(), kMaxLights));
    double sum = lighting.ambient * open / kSkyRays;
    for (const auto& [unshaded, light] : strongest) {
        if (unshaded <= 1e-3) continue;
        int visible = 0;
        for (int i = 0; i < kLightRays; ++i) {
            const Eigen::Vector3d to_light =
                light->p_world + light->radius_m * DirectionFrom(MixBits(key + counter++)) - origin;
            const double distance = to_light.norm();
            if (!Occluded(origin, to_light / distance, distance)) ++visible;
        }
        sum += unshaded * visible / kLightRays;
    }
    return std::min(sum, 1.25);
}

void AnalyticScene::BakeChart(const Lighting& lighting, std::size_t part, int chart_number) {
    const Shape& shape = parts_[part].shape;
    Chart& chart = parts_[part].charts[chart_number];
    const Eigen::Vector2d size = ChartSize(shape, chart_number);
    const double texel = std::clamp(size.maxCoeff() / 96, lighting.texel_m, 0.1);
    chart.light_columns = std::max(static_cast<int>(std::ceil(size.x() / texel)), 2);
    chart.light_rows = std::max(static_cast<int>(std::ceil(size.y() / texel)), 2);
    chart.light_scale_u = static_cast<float>(chart.light_columns / size.x());
    chart.light_scale_v = static_cast<float>(chart.light_rows / size.y());
    chart.light.resize(static_cast<std::size_t>(chart.light_columns) * chart.light_rows);
    const Eigen::Matrix3d R = shape.T_world_shape.linear();
    for (int row = 0; row < chart.light_rows; ++row) {
        for (int column = 0; column < chart.light_columns; ++column) {
            const Eigen::Vector2d uv((column + 0.5) / chart.light_columns * size.x(),
                                     (row + 0.5) / chart.light_rows * size.y());
            const Eigen::Vector3d p = PointOnChart(shape, chart_number, uv);
            const Eigen::Vector3d normal = R * NormalOnChart(shape, chart_number, p);
            const std::size_t texel_index = static_cast<std::size_t>(row) * chart.light_columns + column;
            const std::uint64_t key = StreamKey(part, chart_number, texel_index);
            chart.light[texel_index] =
                static_cast<float>(Irradiance(lighting, shape.T_world_shape * p, normal, key));
        }
    }
}

void AnalyticScene::Finish(const Lighting& lighting) {
    tbb::parallel_for(std::size_t{0}, parts_.size(), [&](std::size_t part) {
        for (int i = 0; i < ChartCount(parts_[part].shape.kind); ++i) {
            if (lighting.baked) {
                BakeChart(lighting, part, i);
                continue;
            }
            const Shape& shape = parts_[part].shape;
            const Eigen::Vector2d centre = 0.5 * ChartSize(shape, i);
            const Eigen::Vector3d normal =
                shape.T_world_shape.linear() * NormalOnChart(shape, i, PointOnChart(shape, i, centre));
            const Eigen::Vector3d sun = Eigen::Vector3d(0.45, -0.55, 0.7).normalized();
            parts_[part].charts[i].light = {static_cast<float>(0.75 + 0.25 * normal.dot(sun))};
        }
    });
}

// Bilinear, continued beyond the border.
float AnalyticScene::LightAt(const Chart& chart, float u, float v) const {
    const float x = std::clamp(u * chart.light_scale_u - 0.5f, 0.0f, static_cast<float>(chart.light_columns - 1));
    const float y = std::clamp(v * chart.light_scale_v - 0.5f, 0.0f, static_cast<float>(chart.light_rows - 1));
    const int x0 = static_cast<int>(x), y0 = static_cast<int>(y);
    const int x1 = std::min(x0 + 1, chart.light_columns - 1), y1 = std::min(y0 + 1, chart.light_rows - 1);
    const float a = x - static_cast<float>(x0), b = y - static_cast<float>(y0);
    const float* row0 = chart.light.data() + static_cast<std::ptrdiff_t>(y0) * chart.light_columns;
    const float* row1 = chart.light.data() + static_cast<std::ptrdiff_t>(y1) * chart.light_columns;
    return (1 - b) * (row0[x0] + a * (row0[x1] - row0[x0])) + b * (row1[x0] + a * (row1[x1] - row1[x0]));
}

}  // namespace tessera
