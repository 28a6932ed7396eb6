// Baked light: computes soft shadows and ambient occlusion once, on a grid over each chart.
#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "synth/analytic_scene.h"
#include "synth/hash_random.h"

namespace tessera {
namespace {

constexpr int kLightRays = 10;  // per light
constexpr int kSkyRays = 16;
constexpr double kSkyReach = 0.8;  // metres; occluders farther away do not darken
constexpr int kMaxLights = 3;  // only the strongest lights at a point; the others hardly contribute
constexpr double kLiftOff = 1e-4;  // metres; shadow rays start this far above their own surface

// Evenly distributed points on the unit sphere: the R2 sequence of the plane (steps 1/g and 1/g^2,
// g^3 = g + 1), which fills a square more evenly than random points, with a random start.
class Directions {
  public:
    explicit Directions(std::uint64_t key)
        : u_(UniformFromBits(key)), v_(UniformFromBits(MixBits(key))) {}
    Eigen::Vector3d Next() {
        u_ += 0.7548776662466927;
        v_ += 0.5698402909980532;
        const double z = 2 * (u_ - std::floor(u_)) - 1, angle = 2 * std::numbers::pi * v_;
        const double r = std::sqrt(std::max(1 - z * z, 0.0));
        return {r * std::cos(angle), r * std::sin(angle), z};
    }

  private:
    double u_, v_;
};

double Unshaded(const Light& light, const Eigen::Vector3d& p, const Eigen::Vector3d& normal) {
    const Eigen::Vector3d to_light = light.p_world - p;
    const double distance2 = std::max(to_light.squaredNorm(), 0.25);
    return light.intensity * std::max(normal.dot(to_light), 0.0) /
           (std::sqrt(distance2) * distance2);
}

}  // namespace

// Bodies that may lie between a chart and the sky or a light. The lists are short, so shadow rays
// are cheap.
struct AnalyticScene::Occluders {
    std::vector<const Part*> near;                   // within kSkyReach
    std::vector<std::vector<const Part*>> to_light;  // one list per light
};

namespace {

bool Blocked(const auto& parts, const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
             double length) {
    for (const auto* part : parts) {
        const Eigen::Vector3d to_centre = part->shape.T_world_shape.translation() - origin;
        const double along = to_centre.dot(direction);
        if (along < -part->radius_m || along > length + part->radius_m) continue;
        if (to_centre.squaredNorm() - along * along > part->radius_m * part->radius_m) continue;
        if (Intersect(part->shape, part->T_shape_world * origin,
                      part->T_shape_world.linear() * direction, length))
            return true;
    }
    return false;
}

// Largest extent of the body along a direction, measured from a point.
double Support(const Shape& shape, const Eigen::Vector3d& p, const Eigen::Vector3d& direction) {
    const Eigen::Vector3d d_shape = shape.T_world_shape.linear().transpose() * direction;
    return direction.dot(shape.T_world_shape.translation() - p) +
           d_shape.cwiseAbs().dot(shape.half_size_m);
}

double DistanceToSegment(const Eigen::Vector3d& p, const Eigen::Vector3d& a,
                         const Eigen::Vector3d& b) {
    const Eigen::Vector3d ab = b - a;
    const double t = std::clamp((p - a).dot(ab) / std::max(ab.squaredNorm(), 1e-12), 0.0, 1.0);
    return (p - a - t * ab).norm();
}

}  // namespace

AnalyticScene::Occluders AnalyticScene::FindOccluders(const Lighting& lighting, const Shape& shape,
                                                      int chart) const {
    const Eigen::Vector2d size = ChartSize(shape, chart);
    const Eigen::Vector3d middle = PointOnChart(shape, chart, 0.5 * size);
    const bool flat =
        shape.kind != ShapeKind::kSphere && !(shape.kind == ShapeKind::kCylinder && chart == 0);
    const Eigen::Vector3d normal =
        shape.T_world_shape.linear() * NormalOnChart(shape, chart, middle);
    const Eigen::Vector3d centre =
        flat ? shape.T_world_shape * middle : shape.T_world_shape.translation();
    const double radius = flat ? 0.5 * size.norm() : shape.half_size_m.norm();
    Occluders occluders;
    occluders.to_light.resize(lighting.lights.size());
    for (const Part& part : parts_) {
        if (part.motion >= 0) continue;
        if (flat && Support(part.shape, centre, normal) < kLiftOff) continue;  // behind the face
        const Eigen::Vector3d p = part.shape.T_world_shape.translation();
        if ((p - centre).norm() < part.radius_m + radius + kSkyReach)
            occluders.near.push_back(&part);
        for (std::size_t i = 0; i < lighting.lights.size(); ++i) {
            const Light& light = lighting.lights[i];
            if (DistanceToSegment(p, centre, light.p_world) <
                part.radius_m + std::max(radius, light.radius_m))
                occluders.to_light[i].push_back(&part);
        }
    }
    return occluders;
}

double AnalyticScene::Irradiance(const Lighting& lighting, const Occluders& occluders,
                                 const Eigen::Vector3d& p, const Eigen::Vector3d& normal,
                                 std::uint64_t key) {
    const Eigen::Vector3d origin = p + kLiftOff * normal;
    Directions directions(key);
    int open = 0;
    for (int i = 0; i < kSkyRays; ++i) {
        // Adding a point of the unit sphere to the normal gives cosine-weighted directions.
        const Eigen::Vector3d d = (normal * 1.0001 + directions.Next()).normalized();
        if (!Blocked(occluders.near, origin, d, kSkyReach)) ++open;
    }
    std::vector<std::pair<double, std::size_t>> strongest;
    for (std::size_t i = 0; i < lighting.lights.size(); ++i)
        strongest.emplace_back(Unshaded(lighting.lights[i], p, normal), i);
    std::stable_sort(strongest.begin(), strongest.end(),
                     [](const auto& a, const auto& b) { return a.first > b.first; });
    strongest.resize(std::min<std::size_t>(strongest.size(), kMaxLights));
    double sum = lighting.ambient * open / kSkyRays;
    for (const auto& [unshaded, number] : strongest) {
        if (unshaded <= 1e-3) continue;
        const Light& light = lighting.lights[number];
        int visible = 0;
        for (int i = 0; i < kLightRays; ++i) {
            const Eigen::Vector3d to_light =
                light.p_world + light.radius_m * directions.Next() - origin;
            const double distance = to_light.norm();
            if (!Blocked(occluders.to_light[number], origin, to_light / distance, distance))
                ++visible;
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
    const Occluders occluders = FindOccluders(lighting, shape, chart_number);
    for (int row = 0; row < chart.light_rows; ++row) {
        for (int column = 0; column < chart.light_columns; ++column) {
            const Eigen::Vector2d uv((column + 0.5) / chart.light_columns * size.x(),
                                     (row + 0.5) / chart.light_rows * size.y());
            const Eigen::Vector3d p = PointOnChart(shape, chart_number, uv);
            const Eigen::Vector3d normal = R * NormalOnChart(shape, chart_number, p);
            const std::size_t texel_index =
                static_cast<std::size_t>(row) * chart.light_columns + column;
            const std::uint64_t key = StreamKey(part, chart_number, texel_index);
            chart.light[texel_index] = static_cast<float>(
                Irradiance(lighting, occluders, shape.T_world_shape * p, normal, key));
        }
    }
}

void AnalyticScene::Finish(const Lighting& lighting) {
    tbb::parallel_for(std::size_t{0}, parts_.size(), [&](std::size_t part) {
        for (int i = 0; i < ChartCount(parts_[part].shape.kind); ++i) {
            if (lighting.baked && parts_[part].motion < 0)
                BakeChart(lighting, part, i);
            else
                SetConstantLight(parts_[part], i);
        }
    });
}

void AnalyticScene::SetConstantLight(Part& part, int chart) {
    const Eigen::Vector2d centre = 0.5 * ChartSize(part.shape, chart);
    const Eigen::Vector3d normal =
        part.shape.T_world_shape.linear() *
        NormalOnChart(part.shape, chart, PointOnChart(part.shape, chart, centre));
    const Eigen::Vector3d sun = Eigen::Vector3d(0.45, -0.55, 0.7).normalized();
    part.charts[chart].light = {static_cast<float>(0.75 + 0.25 * normal.dot(sun))};
}

// Bilinear interpolation, clamped at the border.
float AnalyticScene::LightAt(const Chart& chart, float u, float v) const {
    const float x = std::clamp(u * chart.light_scale_u - 0.5f, 0.0f,
                               static_cast<float>(chart.light_columns - 1));
    const float y =
        std::clamp(v * chart.light_scale_v - 0.5f, 0.0f, static_cast<float>(chart.light_rows - 1));
    const int x0 = static_cast<int>(x), y0 = static_cast<int>(y);
    const int x1 = std::min(x0 + 1, chart.light_columns - 1),
              y1 = std::min(y0 + 1, chart.light_rows - 1);
    const float a = x - static_cast<float>(x0), b = y - static_cast<float>(y0);
    const float* row0 = chart.light.data() + static_cast<std::ptrdiff_t>(y0) * chart.light_columns;
    const float* row1 = chart.light.data() + static_cast<std::ptrdiff_t>(y1) * chart.light_columns;
    return (1 - b) * (row0[x0] + a * (row0[x1] - row0[x0])) +
           b * (row1[x0] + a * (row1[x1] - row1[x0]));
}

}  // namespace tessera
