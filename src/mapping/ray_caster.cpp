#include "mapping/ray_caster.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "mapping/field_sampler.h"

namespace tessera {
namespace {

using Sampler = FieldSampler<BlockMap::View>;

// A ray in voxels from the sampler's origin, by depth along the camera's z: p(z) = start + z *
// step.
struct Ray {
    Eigen::Vector3f start, step;
    float metres_per_voxel;  // of z: 1 / |step|

    Ray(const Eigen::Vector3f& from, const Eigen::Vector3f& direction)
        : start(from), step(direction), metres_per_voxel(1 / direction.norm()) {}
    Eigen::Vector3f At(float z) const { return start + z * step; }
};

struct Hit {
    float depth_m = 0;  // 0: none
    FieldCell cell{};
    FieldSample sample{};
};

class RayWalker {
  public:
    RayWalker(const BlockMap::View& map, const BlockCoord& origin)
        : sampler_(map, origin),
          voxel_m_(map.voxel_size_m),
          truncation_m_(map.truncation_m),
          voxels_per_metre_(1 / map.voxel_size_m) {}

    Hit FirstSurface(const Ray& ray, float first_m, float last_m) {
        // The last known point in front of a surface; none once the walk has met unknown space or a
        // back.
        bool has_front = false;
        float front_z = 0, front_m = 0;
        for (float z = first_m, advance_voxels = 0; z <= last_m;
             z += advance_voxels * ray.metres_per_voxel) {
            const Eigen::Vector3f p = ray.At(z);
            const FieldCell cell = sampler_.Locate(p.x(), p.y(), p.z());
            const Distance distance = DistanceAt(cell);
            if (!distance.known) {
                advance_voxels = cell.block == kUnknownBlock ? VoxelsToBlockEnd(ray, p) : 1.0f;
                has_front = false;
                continue;
            }
            if (distance.metres <= 0 && has_front) {
                const Hit hit = Refine(ray, front_z, front_m, z, distance.metres);
                if (hit.depth_m > 0) return hit;
            }
            has_front = distance.metres > 0;
            front_z = z;
            front_m = distance.metres;
            advance_voxels = distance.step_voxels;
        }
        return {};
    }

  private:
    struct Distance {
        bool known;
        float metres;
        float step_voxels;  // how far to walk on
    };
    static constexpr float kNearVoxels = 1.5f;
    static constexpr float kExactVoxels = 1e-3f;

    // Far from the surface the nearest voxel's, near it interpolated.
    Distance DistanceAt(const FieldCell& cell) const {
        const FieldWord word = sampler_.Nearest(cell);
        if (!HasDistance(word)) return {false, 0, 0};
        const float nearest_m = FieldDistance(word) * truncation_m_;
        const float nearest_voxels = std::abs(nearest_m) * voxels_per_metre_;
        // Stored distances run along the rays that measured them: too long for others, hence less
        // than all of it.
        if (nearest_voxels > kNearVoxels) return {true, nearest_m, 0.8f * nearest_voxels};
        const FieldSample sample = sampler_.Sample<false>(cell);
        // Half a voxel more than to the surface, so that the next step ends behind it.
        return {sample.has_distance, sample.distance.value,
                std::abs(sample.distance.value) * voxels_per_metre_ + 0.5f};
    }

    static float VoxelsToBlockEnd(const Ray& ray, const Eigen::Vector3f& p) {
        constexpr float kBeyond = 1e-2f;
        float least_z = std::numeric_limits<float>::max();
        for (int i = 0; i < 3; ++i) {
            if (ray.step[i] == 0) continue;
            const float low = static_cast<float>(Floor(p[i]) >> 3) * kBlockSide;
            const float end = ray.step[i] > 0 ? low + kBlockSide : low;
            least_z = std::min(least_z, (end - p[i]) / ray.step[i]);
        }
        return std::max(least_z / ray.metres_per_voxel, 0.0f) + kBeyond;
    }

    // The zero between a point in front (distance a_m > 0 at depth a_z) and one behind: regula
    // falsi with the Illinois rule, on interpolated distances.
    Hit Refine(const Ray& ray, float a_z, float a_m, float b_z, float b_m) {
        if (a_m > 0.99f * truncation_m_ && b_m < -0.99f * truncation_m_) return {};
        int last_side = 0;
        for (int i = 0; i < 12; ++i) {
            const float z = a_z + (b_z - a_z) * a_m / (a_m - b_m);
            const Eigen::Vector3f p = ray.At(z);
            const FieldCell cell = sampler_.Locate(p.x(), p.y(), p.z());
            const FieldSample sample = sampler_.Sample<true>(cell);
            if (!sample.has_distance) return {};
            const float distance_m = sample.distance.value;
            if (std::abs(distance_m) < kExactVoxels * voxel_m_) return {z, cell, sample};
            const int side = distance_m > 0 ? 1 : -1;
            if (side > 0) {
                a_z = z;
                a_m = distance_m;
                if (last_side == side) b_m /= 2;
            } else {
                b_z = z;
                b_m = distance_m;
                if (last_side == side) a_m /= 2;
            }
            last_side = side;
        }
        return {};
    }

    Sampler sampler_;
    float voxel_m_, truncation_m_;
    float voxels_per_metre_;
};

// Interpolates the words' parts over the corners that have an intensity, then converts once.
struct Appearance {
    float intensity = -1;
    Rgb8 colour{128, 128, 128};

    Appearance(const BlockMap& map, const Sampler& sampler, const FieldCell& cell) {
        std::int32_t voxel[8];
        sampler.Corners(cell, voxel);
        float total = 0, y = 0, cb = 0, cr = 0;
        for (int c = 0; c < 8; ++c) {
            const FieldWord word = map.field(0)[voxel[c]];
            if (!HasIntensity(word)) continue;
            const ColourWord chroma = map.colour(0)[voxel[c]];
            const float w = (c & 1 ? cell.fx : 1 - cell.fx) * (c & 2 ? cell.fy : 1 - cell.fy) *
                            (c & 4 ? cell.fz : 1 - cell.fz);
            total += w;
            y += w * FieldIntensity(word);
            cb += w * static_cast<float>(chroma & 1023u);
            cr += w * static_cast<float>(chroma >> 10 & 1023u);
        }
        if (total < 1e-3f) return;
        intensity = y / total;
        const auto round = [](float v) { return static_cast<std::uint32_t>(v + 0.5f); };
        const LinearRgb rgb = ColourFromWords(1 + round(intensity * kIntensitySteps),
                                              round(cb / total) | round(cr / total) << 10);
        const auto byte = [](float v) { return static_cast<std::uint8_t>(v * 255.0f + 0.5f); };
        colour = {byte(rgb.r), byte(rgb.g), byte(rgb.b)};
    }
};

class TileCaster {
  public:
    TileCaster(const BlockMap& map, PredictedView& view)
        : map_(map), map_view_(map.view()), view_(view) {
        const double voxel_m = map.config().voxel_size_m;
        const Eigen::Vector3d at = view.T_world_camera.translation() / voxel_m;
        const Eigen::Vector3i block = (at / kBlockSide).array().floor().cast<int>();
        origin_ = {block.x(), block.y(), block.z()};
        start_ = (at - kBlockSide * block.cast<double>()).cast<float>();
        voxel_from_camera_ = (view.T_world_camera.linear() / voxel_m).cast<float>();
        camera_from_world_ = view.T_world_camera.linear().transpose().cast<float>();
    }

    // One tile of RayRanges: neighbouring rays read the same blocks.
    void Cast(int tile_x, int tile_y, const RayRanges& ranges) const {
        constexpr int kTile = RayRanges::kTilePx;
        const PinholeCamera& camera = view_.camera;
        const auto& [first_m, last_m] =
            ranges.ranges[static_cast<std::size_t>(tile_y * ranges.width + tile_x)];
        RayWalker walker(map_view_, origin_);
        for (int v = tile_y * kTile; v < std::min((tile_y + 1) * kTile, camera.height); ++v)
            for (int u = tile_x * kTile; u < std::min((tile_x + 1) * kTile, camera.width); ++u) {
                const Eigen::Vector3f direction = camera.Unproject(u, v, 1).cast<float>();
                const Ray ray(start_, voxel_from_camera_ * direction);
                Store(u, v, walker.FirstSurface(ray, first_m, last_m));
            }
    }

  private:
    void Store(int u, int v, const Hit& hit) const {
        view_.depth_m(u, v) = hit.depth_m;
        if (hit.depth_m == 0) {
            view_.normal_camera(u, v).setZero();
            view_.colour(u, v) = {};
            view_.intensity(u, v) = 0;
            return;
        }
        const auto& g = hit.sample.distance;
        view_.normal_camera(u, v) =
            (camera_from_world_ * Eigen::Vector3f(g.gx, g.gy, g.gz)).normalized();
        const Appearance appearance(map_, Sampler(map_view_, origin_), hit.cell);
        view_.colour(u, v) = appearance.colour;
        view_.intensity(u, v) = appearance.intensity;
    }

    const BlockMap& map_;
    const BlockMap::View map_view_;
    PredictedView& view_;
    BlockCoord origin_;
    Eigen::Vector3f start_;
    Eigen::Matrix3f voxel_from_camera_, camera_from_world_;
};

}  // namespace

void RayCaster::Predict(const BlockMap& map, const PinholeCamera& camera,
                        const Eigen::Isometry3d& T_world_camera, float min_depth_m,
                        float max_depth_m, PredictedView& view) {
    view.Resize(camera, T_world_camera);
    ranges_.Build(map, camera, T_world_camera, min_depth_m, max_depth_m);
    const TileCaster caster(map, view);
    tbb::parallel_for(0, ranges_.height, [&](int y) {
        for (int x = 0; x < ranges_.width; ++x) caster.Cast(x, y, ranges_);
    });
}

}  // namespace tessera
