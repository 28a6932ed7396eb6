// Casts the rays of one camera through an analytic scene. Computes each body's transform and pixel
// rectangle once per view, so that a tile of pixels tests only the few bodies that may cover it,
// front to back.
#include <algorithm>
#include <cmath>

#include "synth/analytic_scene.h"

namespace tessera {

class AnalyticView : public ViewCaster {
  public:
    AnalyticView(const AnalyticScene& scene, const PinholeCamera& camera,
                 const Eigen::Isometry3d& T_world_camera, double time_s);
    void Cast(const PixelRect& rect, double offset_x_px, double offset_y_px,
              std::span<SurfaceHit> hits) const override;

  private:
    struct Candidate {
        int part;
        double nearest_z;  // lower bound of the body's depth along the optical axis, metres
        double x_min, x_max, y_min, y_max;  // pixels
        Eigen::Vector3d origin;             // camera centre in the shape's frame
        Eigen::Matrix3d R_shape_camera;
        Eigen::Matrix<double, 3, 8> p_camera;  // corners of the bounding box
        bool unbounded;  // extends behind the camera, so the rectangle is not valid
    };
    // `T_placed_camera`: the camera pose relative to the parts as they were added.
    void Add(int part, const Eigen::Isometry3d& T_placed_camera);
    bool InTile(const Candidate& candidate, const PixelRect& rect, double offset_x_px,
                double offset_y_px) const;
    const Candidate* Nearest(std::span<const Candidate* const> candidates, const Candidate* first,
                             const Eigen::Vector3d& d_camera, SurfaceHit& best) const;
    void Describe(const Candidate& winner, const Eigen::Vector3d& d_camera, SurfaceHit& hit) const;

    const AnalyticScene& scene_;
    PinholeCamera camera_;
    std::vector<Candidate> candidates_;  // sorted by nearest_z
};

AnalyticView::AnalyticView(const AnalyticScene& scene, const PinholeCamera& camera,
                           const Eigen::Isometry3d& T_world_camera, double time_s)
    : scene_(scene), camera_(camera) {
    std::vector<Eigen::Isometry3d> T_placed_camera;  // one per motion
    for (const AnalyticScene::Motion& motion : scene.motions_)
        T_placed_camera.push_back(motion(time_s).inverse() * T_world_camera);
    for (std::size_t i = 0; i < scene.parts_.size(); ++i) {
        const int motion = scene.parts_[i].motion;
        Add(static_cast<int>(i), motion < 0 ? T_world_camera : T_placed_camera[motion]);
    }
    std::stable_sort(
        candidates_.begin(), candidates_.end(),
        [](const Candidate& a, const Candidate& b) { return a.nearest_z < b.nearest_z; });
}

void AnalyticView::Add(int number, const Eigen::Isometry3d& T_placed_camera) {
    // Metres; corners closer to the camera plane than this do not bound any pixels.
    constexpr double kNear = 1e-3;
    const AnalyticScene::Part& part = scene_.parts_[number];
    const Eigen::Isometry3d T_shape_camera = part.T_shape_world * T_placed_camera;
    const Eigen::Isometry3d T_camera_shape = T_shape_camera.inverse();
    constexpr double kAll = 1e9;
    Candidate c;
    c.part = number;
    c.nearest_z = c.x_min = c.y_min = kAll;
    c.x_max = c.y_max = -kAll;
    c.origin = T_shape_camera.translation();
    c.R_shape_camera = T_shape_camera.linear();
    bool any_in_front = false;
    c.unbounded = false;
    for (int corner = 0; corner < 8; ++corner) {
        const Eigen::Vector3d sign((corner & 1) ? 1 : -1, (corner & 2) ? 1 : -1,
                                   (corner & 4) ? 1 : -1);
        const Eigen::Vector3d p = T_camera_shape * part.shape.half_size_m.cwiseProduct(sign).eval();
        c.p_camera.col(corner) = p;
        c.nearest_z = std::min(c.nearest_z, p.z());
        (p.z() > kNear ? any_in_front : c.unbounded) = true;
        if (p.z() <= kNear) continue;
        const Eigen::Vector2d pixel = camera_.Project(p);
        c.x_min = std::min(c.x_min, pixel.x());
        c.x_max = std::max(c.x_max, pixel.x());
        c.y_min = std::min(c.y_min, pixel.y());
        c.y_max = std::max(c.y_max, pixel.y());
    }
    if (any_in_front) candidates_.push_back(c);
}

// Returns false only if no ray of the tile can hit the body.
bool AnalyticView::InTile(const Candidate& c, const PixelRect& rect, double offset_x_px,
                          double offset_y_px) const {
    const double left = rect.x_begin + offset_x_px, right = rect.x_end - 1 + offset_x_px;
    const double top = rect.y_begin + offset_y_px, bottom = rect.y_end - 1 + offset_y_px;
    if (!c.unbounded)
        return c.x_max >= left && c.x_min <= right && c.y_max >= top && c.y_min <= bottom;
    // All corners lie outside one side plane of the tile's frustum.
    const auto x = c.p_camera.row(0).array(), y = c.p_camera.row(1).array(),
               z = c.p_camera.row(2).array();
    return (x >= (left - camera_.cx) / camera_.fx * z).any() &&
           (x <= (right - camera_.cx) / camera_.fx * z).any() &&
           (y >= (top - camera_.cy) / camera_.fy * z).any() &&
           (y <= (bottom - camera_.cy) / camera_.fy * z).any();
}

// Tests `first` first: the body that the neighbouring ray hit, so that everything behind it is
// skipped.
const AnalyticView::Candidate* AnalyticView::Nearest(std::span<const Candidate* const> candidates,
                                                     const Candidate* first,
                                                     const Eigen::Vector3d& d_camera,
                                                     SurfaceHit& best) const {
    const Candidate* winner = nullptr;
    const auto attempt = [&](const Candidate& candidate) {
        const auto hit = Intersect(scene_.parts_[candidate.part].shape, candidate.origin,
                                   candidate.R_shape_camera * d_camera, best.t);
        if (!hit) return;
        winner = &candidate;
        best.t = hit->t;
        best.chart = hit->chart;
    };
    if (first) attempt(*first);
    for (const Candidate* candidate : candidates) {
        if (candidate->nearest_z > best.t) break;
        if (candidate != first) attempt(*candidate);
    }
    return winner;
}

void AnalyticView::Describe(const Candidate& winner, const Eigen::Vector3d& d_camera,
                            SurfaceHit& hit) const {
    hit.part = winner.part;
    const Shape& shape = scene_.parts_[hit.part].shape;
    const Eigen::Vector3d d = winner.R_shape_camera * d_camera;
    const Eigen::Vector3d p = winner.origin + hit.t * d;
    const Eigen::Vector2d uv = ChartPoint(shape, hit.chart, p);
    hit.u = static_cast<float>(uv.x());
    hit.v = static_cast<float>(uv.y());
    hit.cos_incidence = std::abs(static_cast<float>(AlongNormal(shape, hit.chart, p, d))) /
                        std::sqrt(static_cast<float>(d_camera.squaredNorm()));
}

void AnalyticView::Cast(const PixelRect& rect, double offset_x_px, double offset_y_px,
                        std::span<SurfaceHit> hits) const {
    std::vector<const Candidate*> tile;
    tile.reserve(candidates_.size());
    for (const Candidate& c : candidates_)
        if (InTile(c, rect, offset_x_px, offset_y_px)) tile.push_back(&c);
    const Candidate* last = nullptr;
    std::size_t i = 0;
    const double per_fx = 1 / camera_.fx, per_fy = 1 / camera_.fy;
    for (int y = rect.y_begin; y < rect.y_end; ++y) {
        const double d_y = (y + offset_y_px - camera_.cy) * per_fy;
        for (int x = rect.x_begin; x < rect.x_end; ++x, ++i) {
            const Eigen::Vector3d d_camera((x + offset_x_px - camera_.cx) * per_fx, d_y, 1.0);
            hits[i] = {};
            last = Nearest(tile, last, d_camera, hits[i]);
            if (last) Describe(*last, d_camera, hits[i]);
        }
    }
}

std::unique_ptr<ViewCaster> AnalyticScene::View(const PinholeCamera& camera,
                                                const Eigen::Isometry3d& T_world_camera,
                                                double time_s) const {
    return std::make_unique<AnalyticView>(*this, camera, T_world_camera, time_s);
}

}  // namespace tessera
