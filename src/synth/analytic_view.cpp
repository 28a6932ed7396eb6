// One camera's rays through an analytic scene: each body's transform and its rectangle of pixels are found once for
// the view, so that a tile of pixels tries only the few bodies that can be in it, front to back.
#include <algorithm>
#include <cmath>

#include "synth/analytic_scene.h"

namespace tessera {

class AnalyticView : public ViewCaster {
  public:
    AnalyticView(const AnalyticScene& scene, const PinholeCamera& camera, const Eigen::Isometry3d& T_world_camera);
    void Cast(const PixelRect& rect, double offset_x_px, double offset_y_px,
              std::span<SurfaceHit> hits) const override;

  private:
    struct Candidate {
        int part;
        double nearest_z;                 // no point of the body is nearer, metres along the optical axis
        double x_min, x_max, y_min, y_max;  // pixels
        Eigen::Vector3d origin;           // the camera's centre in the shape's frame
        Eigen::Matrix3d R_shape_camera;
    };
    void Add(int part, const Eigen::Isometry3d& T_world_camera);
    SurfaceHit Nearest(std::span<const Candidate* const> candidates, const Eigen::Vector3d& d_camera) const;

    const AnalyticScene& scene_;
    PinholeCamera camera_;
    std::vector<Candidate> candidates_;  // by nearest_z
};

AnalyticView::AnalyticView(const AnalyticScene& scene, const PinholeCamera& camera,
                           const Eigen::Isometry3d& T_world_camera)
    : scene_(scene), camera_(camera) {
    for (std::size_t i = 0; i < scene.parts_.size(); ++i) Add(static_cast<int>(i), T_world_camera);
    std::stable_sort(candidates_.begin(), candidates_.end(),
                     [](const Candidate& a, const Candidate& b) { return a.nearest_z < b.nearest_z; });
}

void AnalyticView::Add(int number, const Eigen::Isometry3d& T_world_camera) {
    constexpr double kNear = 1e-3;  // a corner this close to the camera's plane bounds no pixels, metres
    const AnalyticScene::Part& part = scene_.parts_[number];
    const Eigen::Isometry3d T_shape_camera = part.T_shape_world * T_world_camera;
    const Eigen::Isometry3d T_camera_shape = T_shape_camera.inverse();
    constexpr double kAll = 1e9;
    Candidate c{number, kAll, kAll, -kAll, kAll, -kAll, T_shape_camera.translation(), T_shape_camera.linear()};
    bool any_in_front = false, any_behind = false;
    for (int corner = 0; corner < 8; ++corner) {
        const Eigen::Vector3d sign((corner & 1) ? 1 : -1, (corner & 2) ? 1 : -1, (corner & 4) ? 1 : -1);
        const Eigen::Vector3d p = T_camera_shape * part.shape.half_size_m.cwiseProduct(sign).eval();
        c.nearest_z = std::min(c.nearest_z, p.z());
        (p.z() > kNear ? any_in_front : any_behind) = true;
        if (p.z() <= kNear) continue;
        const Eigen::Vector2d pixel = camera_.Project(p);
        c.x_min = std::min(c.x_min, pixel.x());
        c.x_max = std::max(c.x_max, pixel.x());
        c.y_min = std::min(c.y_min, pixel.y());
        c.y_max = std::max(c.y_max, pixel.y());
    }
    if (!any_in_front) return;
    if (any_behind) c.x_min = c.y_min = -kAll, c.x_max = c.y_max = kAll;
    candidates_.push_back(c);
}

SurfaceHit AnalyticView::Nearest(std::span<const Candidate* const> candidates,
                                 const Eigen::Vector3d& d_camera) const {
    SurfaceHit best;
    const Candidate* winner = nullptr;
    for (const Candidate* candidate : candidates) {
        if (candidate->nearest_z > best.t) break;
        const auto hit = Intersect(scene_.parts_[candidate->part].shape, candidate->origin,
                                   candidate->R_shape_camera * d_camera, best.t);
        if (!hit) continue;
        winner = candidate;
        best.t = hit->t;
        best.chart = hit->chart;
    }
    if (!winner) return best;
    best.part = winner->part;
    const Shape& shape = scene_.parts_[best.part].shape;
    const Eigen::Vector3d d = winner->R_shape_camera * d_camera;
    const Eigen::Vector3d p = winner->origin + best.t * d;
    const Eigen::Vector2d uv = ChartPoint(shape, best.chart, p);
    best.u = static_cast<float>(uv.x());
    best.v = static_cast<float>(uv.y());
    best.cos_incidence =
        static_cast<float>(std::abs(NormalOnChart(shape, best.chart, p).dot(d)) / d_camera.norm());
    return best;
}

void AnalyticView::Cast(const PixelRect& rect, double offset_x_px, double offset_y_px,
                        std::span<SurfaceHit> hits) const {
    std::vector<const Candidate*> tile;
    tile.reserve(candidates_.size());
    for (const Candidate& c : candidates_) {
        if (c.x_max < rect.x_begin + offset_x_px || c.x_min > rect.x_end - 1 + offset_x_px ||
            c.y_max < rect.y_begin + offset_y_px || c.y_min > rect.y_end - 1 + offset_y_px)
            continue;
        tile.push_back(&c);
    }
    std::size_t i = 0;
    for (int y = rect.y_begin; y < rect.y_end; ++y)
        for (int x = rect.x_begin; x < rect.x_end; ++x, ++i)
            hits[i] = Nearest(tile, camera_.Unproject(x + offset_x_px, y + offset_y_px, 1.0));
}

std::unique_ptr<ViewCaster> AnalyticScene::View(const PinholeCamera& camera,
                                                const Eigen::Isometry3d& T_world_camera) const {
    return std::make_unique<AnalyticView>(*this, camera, T_world_camera);
}

}  // namespace tessera
