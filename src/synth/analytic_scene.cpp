#include "synth/analytic_scene.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/check.h"

namespace tessera {
int AnalyticScene::AddTexture(const ColourImage& image, Texture::Wrap wrap) {
    textures_.emplace_back(image, wrap);
    return static_cast<int>(textures_.size()) - 1;
}

void AnalyticScene::BeginInstance(const std::string& name, const std::string& class_name) {
    if (class_name.empty()) {
        current_instance_ = 0;
        return;
    }
    auto found = std::find(class_names_.begin() + 1, class_names_.end(), class_name);
    if (found == class_names_.end()) found = class_names_.insert(found, class_name);
    instances_.push_back({name, static_cast<int>(found - class_names_.begin())});
    current_instance_ = static_cast<int>(instances_.size()) - 1;
}

void AnalyticScene::BeginMotion(Motion motion) {
    current_motion_ = motion ? static_cast<int>(motions_.size()) : -1;
    if (motion) motions_.push_back(std::move(motion));
}

int AnalyticScene::AddShape(const Shape& shape, const Paint& paint) {
    Part part;
    part.shape = shape;
    part.T_shape_world = shape.T_world_shape.inverse();
    part.radius_m = shape.half_size_m.norm();
    part.instance = current_instance_;
    part.motion = current_motion_;
    Tessellate(part);
    for (int corner = 0; corner < 8 && part.motion < 0; ++corner) {
        const Eigen::Vector3d sign((corner & 1) ? 1 : -1, (corner & 2) ? 1 : -1,
                                   (corner & 4) ? 1 : -1);
        bounds_.extend(shape.T_world_shape * shape.half_size_m.cwiseProduct(sign));
    }
    parts_.push_back(std::move(part));
    const int number = static_cast<int>(parts_.size()) - 1;
    for (int chart = 0; chart < ChartCount(shape.kind); ++chart) SetPaint(number, chart, paint);
    return number;
}

void AnalyticScene::SetPaint(int part, int chart, const Paint& paint) {
    TESSERA_CHECK(paint.texture >= 0 && paint.texture < static_cast<int>(textures_.size()),
                  "texture {} of {}", paint.texture, textures_.size());
    const Eigen::Vector2d size = ChartSize(parts_[part].shape, chart);
    Chart& c = parts_[part].charts[chart];
    c.paint = paint;
    const double width = paint.width_m > 0 ? paint.width_m : size.x();
    const double height = paint.height_m > 0 ? paint.height_m : size.y();
    c.scale_u = static_cast<float>(1 / width);
    c.scale_v = static_cast<float>(1 / height);
    c.offset_u = static_cast<float>(paint.offset_u_m / width);
    c.offset_v = static_cast<float>(paint.offset_v_m / height);
}

SurfaceHit AnalyticScene::CastRay(const Eigen::Vector3d& origin,
                                  const Eigen::Vector3d& direction) const {
    const double length2 = direction.squaredNorm();
    SurfaceHit best;
    for (std::size_t i = 0; i < parts_.size(); ++i) {
        const Part& part = parts_[i];
        if (part.motion >= 0) continue;
        const Eigen::Vector3d to_centre = part.shape.T_world_shape.translation() - origin;
        const double along = to_centre.dot(direction);
        if (to_centre.squaredNorm() - along * along / length2 > part.radius_m * part.radius_m)
            continue;
        const Eigen::Vector3d o = part.T_shape_world * origin;
        const Eigen::Vector3d d = part.T_shape_world.linear() * direction;
        if (const auto hit = Intersect(part.shape, o, d, best.t); hit) {
            best.t = hit->t;
            best.part = static_cast<int>(i);
            best.chart = hit->chart;
            const Eigen::Vector3d p = o + hit->t * d;
            const Eigen::Vector2d uv = ChartPoint(part.shape, hit->chart, p);
            best.u = static_cast<float>(uv.x());
            best.v = static_cast<float>(uv.y());
            best.cos_incidence = static_cast<float>(
                std::abs(NormalOnChart(part.shape, hit->chart, p).dot(d)) / std::sqrt(length2));
        }
    }
    return best;
}

Eigen::Vector3d AnalyticScene::Normal(const SurfaceHit& hit) const {
    const Shape& shape = parts_[hit.part].shape;
    const Eigen::Vector3d p = PointOnChart(shape, hit.chart, {hit.u, hit.v});
    return shape.T_world_shape.linear() * NormalOnChart(shape, hit.chart, p);
}

RgbF AnalyticScene::Colour(const SurfaceHit& hit, float footprint_m) const {
    const Chart& chart = parts_[hit.part].charts[hit.chart];
    const RgbF colour = textures_[chart.paint.texture].Sample(
        hit.u * chart.scale_u + chart.offset_u, hit.v * chart.scale_v + chart.offset_v,
        footprint_m * chart.scale_u);
    const float light = LightAt(chart, hit.u, hit.v);
    return {colour.r * light, colour.g * light, colour.b * light};
}

Mobility AnalyticScene::MobilityOf(const SurfaceHit& hit, double time_s) const {
    const Part& part = parts_[hit.part];
    if (part.motion < 0) return Mobility::kStatic;
    constexpr double kStep_s = 1.0 / 60, kStill_m = 1e-4;
    const Motion& motion = motions_[part.motion];
    const Eigen::Vector3d& centre = part.shape.T_world_shape.translation();
    const Eigen::Vector3d way =
        motion(time_s + kStep_s) * centre - motion(time_s - kStep_s) * centre;
    return way.norm() > kStill_m ? Mobility::kMoving : Mobility::kResting;
}

int AnalyticScene::InstanceOf(const SurfaceHit& hit) const { return parts_[hit.part].instance; }

std::optional<double> AnalyticScene::SignedDistance(const Eigen::Vector3d& p_world) const {
    double nearest = std::numeric_limits<double>::infinity();
    for (const Part& part : parts_)
        if (part.motion < 0)
            nearest = std::min(nearest,
                               tessera::SignedDistance(part.shape, part.T_shape_world * p_world));
    return nearest;
}

}  // namespace tessera
