#include "export/occupancy.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <new>

#include "export/surface_samples.h"
#include "mapping/ray_caster.h"

namespace tessera {
namespace {

constexpr float kNearest_m = 0.05f;  // the nearest surface that a camera sees

// The cells of a row whose centres one camera may see: start + i * step, for i in [first, last).
struct VisibleCells {
    Eigen::Vector3f start, step;  // camera frame, metres
    int first = 0, last = 0;

    VisibleCells(const Eigen::Vector3d& start_m, const Eigen::Vector3d& step_m, int count)
        : start(start_m.cast<float>()), step(step_m.cast<float>()), last(count) {}

    // Keeps the half space normal * p >= offset, and up to a cell more.
    void Clip(const Eigen::Vector3f& normal, float offset) {
        const float at_start = normal.dot(start) - offset, slope = normal.dot(step);
        if (std::abs(slope) < 1e-9f) {
            if (at_start < 0) last = first;
            return;
        }
        const float border = std::clamp(-at_start / slope, -1e9f, 1e9f);
        if (slope > 0)
            first = std::max(first, static_cast<int>(std::floor(border)));
        else
            last = std::min(last, static_cast<int>(std::ceil(border)) + 1);
    }
};

class Carver {
  public:
    Carver(const CellGrid& grid, const std::vector<std::int8_t>& sides, double max_range_m,
           std::vector<CellState>& cells)
        : grid_(grid), sides_(sides), max_range_m_(max_range_m), cells_(cells) {}

    void Carve(const PredictedView& view) const {
        tbb::parallel_for(0, grid_.size.z(), [&](int z) {
            for (int y = 0; y < grid_.size.y(); ++y) CarveRow(view, y, z);
        });
    }

  private:
    void CarveRow(const PredictedView& view, int y, int z) const {
        const Eigen::Isometry3d T_camera_grid = view.T_world_camera.inverse() * grid_.T_world_grid;
        VisibleCells row(T_camera_grid * grid_.Centre(0, y, z),
                         T_camera_grid.linear().col(0) * grid_.resolution_m, grid_.size.x());
        const PinholeCamera& c = view.camera;
        const auto fx = static_cast<float>(c.fx), fy = static_cast<float>(c.fy),
                   cx = static_cast<float>(c.cx), cy = static_cast<float>(c.cy);
        row.Clip({0, 0, 1}, 0.001f);
        row.Clip({0, 0, -1}, static_cast<float>(-max_range_m_));
        row.Clip({fx, 0, cx}, 0);
        row.Clip({-fx, 0, static_cast<float>(c.width - 1) - cx}, 0);
        row.Clip({0, fy, cy}, 0);
        row.Clip({0, -fy, static_cast<float>(c.height - 1) - cy}, 0);
        const std::size_t offset = grid_.Index(0, y, z);
        for (int x = row.first; x < row.last; ++x) {
            const std::size_t cell = offset + static_cast<std::size_t>(x);
            if (cells_[cell] != CellState::kUnknown || sides_[cell] < 0) continue;
            const Eigen::Vector3f p = row.start + static_cast<float>(x) * row.step;
            if (p.z() <= 0) continue;
            const float u = fx * p.x() / p.z() + cx, v = fy * p.y() / p.z() + cy;
            if (!(u >= 0 && v >= 0 && u < static_cast<float>(c.width - 1) &&
                  v < static_cast<float>(c.height - 1)))
                continue;
            const float* depth_m = view.depth_m.row(static_cast<int>(v)) + static_cast<int>(u);
            // 0 is no surface, and so never behind the cell.
            const float nearest_m = std::min(std::min(depth_m[0], depth_m[1]),
                                             std::min(depth_m[c.width], depth_m[c.width + 1]));
            if (p.z() < nearest_m) cells_[cell] = CellState::kFree;
        }
    }

    const CellGrid& grid_;
    const std::vector<std::int8_t>& sides_;
    const double max_range_m_;
    std::vector<CellState>& cells_;
};

Occupancy Make(const BlockMap& map, const CellGrid& grid, const PinholeCamera& camera,
               const std::vector<StampedPose>& path, const Occupancy::Options& options) {
    constexpr int kMostColumns = 320;
    Occupancy occupancy{grid, std::vector<CellState>(grid.cells(), CellState::kUnknown)};
    const std::vector<std::int8_t> sides = ObservedSides(map, grid);
    for (std::size_t i = 0; i < sides.size(); ++i)
        if (sides[i] > 0) occupancy.cells[i] = CellState::kFree;
    for (const Eigen::Vector3f& p : SurfacePoints(map, grid, options.min_weight))
        occupancy.cells[grid.Index(static_cast<int>(p.x()), static_cast<int>(p.y()),
                                   static_cast<int>(p.z()))] = CellState::kOccupied;
    const Carver carver(grid, sides, options.max_range_m, occupancy.cells);
    const PinholeCamera coarse =
        camera.Every(std::max(1, (camera.width + kMostColumns - 1) / kMostColumns));
    const auto most = static_cast<std::size_t>(options.most_views);
    const std::size_t stride = std::max<std::size_t>(1, (path.size() + most - 1) / most);
    RayCaster caster;
    PredictedView view;
    for (std::size_t i = 0; i < path.size(); i += stride) {
        caster.Predict(map, coarse, path[i].T_world_camera, kNearest_m,
                       static_cast<float>(options.max_range_m), view);
        carver.Carve(view);
    }
    return occupancy;
}

}  // namespace

Result<Occupancy> MakeOccupancy(const BlockMap& map, const CellGrid& grid,
                                const PinholeCamera& camera, const std::vector<StampedPose>& path,
                                const Occupancy::Options& options) {
    TESSERA_CHECK(options.most_views > 0, "{} views", options.most_views);
    if (Status status = CheckResolution(grid, map.config()); !status.ok()) return status;
    try {
        return Make(map, grid, camera, path, options);
    } catch (const std::bad_alloc&) {
        return Status::Error(
            "the occupancy does not fit in memory; take a smaller box or a coarser resolution");
    }
}

}  // namespace tessera
