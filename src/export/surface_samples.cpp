#include "export/surface_samples.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "mapping/block_mesh.h"
#include "mapping/cell_bits.h"
#include "mapping/field_sampler.h"

namespace tessera {
namespace {

// The surface's points in one block.
class BlockPoints {
  public:
    BlockPoints(const BlockMap& map, const CellGrid& grid, double min_weight)
        : map_(map),
          view_(map.view()),
          limits_(MakeCellLimits(min_weight, map.config())),
          steps_(static_cast<int>(
              std::ceil(2 * map.config().voxel_size_m / grid.resolution_m - 1e-9))),
          size_(grid.size.cast<float>()) {
        const Eigen::Isometry3d T_grid_world = grid.T_world_grid.inverse();
        const double cells_per_voxel = map.config().voxel_size_m / grid.resolution_m;
        cells_from_voxels_ = T_grid_world.linear() * cells_per_voxel;
        offset_ = (T_grid_world.translation() - grid.Low()) / grid.resolution_m;
        // From a block's middle to its farthest sample, along each axis of the grid.
        reach_ = cells_from_voxels_.cwiseAbs() * Eigen::Vector3d::Constant(0.5 * kBlockSide + 1);
        turn_ = cells_from_voxels_.cast<float>();
    }

    void Add(BlockId id, std::vector<Eigen::Vector3f>& points) const {
        const BlockCoord c = map_.coord(id);
        const Eigen::Vector3d corner =
            cells_from_voxels_ * (kBlockSide * Eigen::Vector3d(c.x, c.y, c.z)) + offset_;
        const Eigen::Vector3d middle =
            corner + cells_from_voxels_ * Eigen::Vector3d::Constant(0.5 * kBlockSide);
        if (((middle + reach_).array() < 0).any() ||
            ((middle - reach_).array() > size_.cast<double>().array()).any())
            return;
        std::array<BlockId, 8> blocks;
        std::copy_n(view_.neighbours + 8 * static_cast<std::int64_t>(id), 8, blocks.begin());
        const CellBits bits(map_, blocks, limits_);
        if (!bits.HasBothSigns()) return;
        const CellRows rows = bits.view();
        const auto has_surface = [&](int x, int y, int z) {
            return std::max({x, y, z}) < kBlockSide && (rows.SurfaceCells(y, z) >> x & 1) != 0;
        };
        for (int z = 0; z < kBlockSide; ++z)
            for (int y = 0; y < kBlockSide; ++y)
                for (std::uint32_t cells = rows.SurfaceCells(y, z); cells != 0;
                     cells &= cells - 1) {
                    const int x = std::countr_zero(cells);
                    const Eigen::Vector3i ends = Eigen::Vector3i(steps_ - has_surface(x + 1, y, z),
                                                                 steps_ - has_surface(x, y + 1, z),
                                                                 steps_ - has_surface(x, y, z + 1));
                    AddCell(blocks, {x, y, z}, ends, corner, points);
                }
    }

  private:
    // `ends`: the last step along each axis. The upper neighbour, if it has surface, adds the edges
    // on the side between them.
    void AddCell(const std::array<BlockId, 8>& blocks, const Eigen::Vector3i& at,
                 const Eigen::Vector3i& ends, const Eigen::Vector3d& corner,
                 std::vector<Eigen::Vector3f>& points) const {
        float distance[8];
        for (int c = 0; c < 8; ++c) {
            const auto [slot, offset] =
                PlaceOf(at.x() + (c & 1), at.y() + (c >> 1 & 1), at.z() + (c >> 2));
            distance[c] = FieldDistance(map_.field(blocks[static_cast<std::size_t>(slot)])[offset]);
        }
        const float step = 1.0f / static_cast<float>(steps_);
        const Eigen::Vector3f origin = corner.cast<float>() + turn_ * at.cast<float>();
        for (int k = 0; k <= ends.z(); ++k)
            for (int j = 0; j <= ends.y(); ++j)
                for (int i = 0; i <= ends.x(); ++i) {
                    const Eigen::Vector3i from(i, j, k);
                    const Eigen::Vector3f p = step * from.cast<float>();
                    const float here = Value(distance, p);
                    for (int axis = 0; axis < 3; ++axis) {
                        if (from(axis) == steps_) continue;
                        Eigen::Vector3f q = p;
                        q(axis) += step;
                        const float there = Value(distance, q);
                        if ((here < 0) == (there < 0)) continue;
                        q(axis) = p(axis) + step * here / (here - there);
                        const Eigen::Vector3f point = origin + turn_ * q;
                        if ((point.array() >= 0).all() && (point.array() < size_.array()).all())
                            points.push_back(point);
                    }
                }
    }

    static float Value(const float* distance, const Eigen::Vector3f& p) {
        // At the corners, exactly the voxel's own value, and so its sign.
        const auto mix = [](float a, float b, float t) { return t < 1 ? a + t * (b - a) : b; };
        const auto plane = [&](const float* d) {
            return mix(mix(d[0], d[1], p.x()), mix(d[2], d[3], p.x()), p.y());
        };
        return mix(plane(distance), plane(distance + 4), p.z());
    }

    const BlockMap& map_;
    const BlockMapView view_;
    const CellLimits limits_;
    const int steps_;  // samples per voxel
    const Eigen::Vector3f size_;
    Eigen::Matrix3d cells_from_voxels_;
    Eigen::Vector3d offset_, reach_;
    Eigen::Matrix3f turn_;
};

}  // namespace

Status CheckResolution(const CellGrid& grid, const BlockMap::Config& map) {
    if (grid.resolution_m >= kFinestCell * map.voxel_size_m) return Status::Ok();
    return Status::Error(
        fmt::format("a resolution of {:g} m is finer than a quarter of the map's voxels; take at "
                    "least {:g} m",
                    grid.resolution_m, kFinestCell * map.voxel_size_m));
}

std::vector<Eigen::Vector3f> SurfacePoints(const BlockMap& map, const CellGrid& grid,
                                           double min_weight) {
    constexpr BlockId kPart = 128;  // fixed, so that the order does not depend on the threads
    const BlockPoints block(map, grid, min_weight);
    std::vector<std::vector<Eigen::Vector3f>> parts(
        static_cast<std::size_t>((map.size() + kPart - 1) / kPart));
    tbb::parallel_for(std::size_t{0}, parts.size(), [&](std::size_t part) {
        const BlockId first = static_cast<BlockId>(part) * kPart;
        for (BlockId id = std::max(first, 1); id < std::min(first + kPart, map.size()); ++id)
            if (!map.IsFree(id)) block.Add(id, parts[part]);
    });
    std::size_t count = 0;
    for (const auto& part : parts) count += part.size();
    std::vector<Eigen::Vector3f> points;
    points.reserve(count);
    for (const auto& part : parts) points.insert(points.end(), part.begin(), part.end());
    return points;
}

std::vector<std::int8_t> ObservedSides(const BlockMap& map, const CellGrid& grid) {
    std::vector<std::int8_t> sides(grid.cells());
    const double voxel_m = map.config().voxel_size_m;
    const BlockMapView view = map.view();
    tbb::parallel_for(0, grid.size.z(), [&](int z) {
        for (int y = 0; y < grid.size.y(); ++y) {
            const Eigen::Vector3d start = grid.T_world_grid * grid.Centre(0, y, z) / voxel_m,
                                  step = grid.T_world_grid.linear().col(0) *
                                         (grid.resolution_m / voxel_m);
            const Eigen::Vector3d block = (start / kBlockSide).array().floor();
            // Relative to the row's first block, so that floats stay accurate.
            const Eigen::Vector3d local = start - kBlockSide * block;
            FieldSampler<BlockMapView> sampler(
                view, {static_cast<std::int32_t>(block.x()), static_cast<std::int32_t>(block.y()),
                       static_cast<std::int32_t>(block.z())});
            std::int8_t* row = sides.data() + grid.Index(0, y, z);
            for (int x = 0; x < grid.size.x(); ++x) {
                const Eigen::Vector3f p = (local + x * step).cast<float>();
                const FieldCell cell = sampler.Locate(p.x(), p.y(), p.z());
                if (cell.block == kUnknownBlock) continue;
                const FieldSample sample = sampler.Sample<false>(cell);
                if (sample.has_distance) row[x] = sample.distance.value < 0 ? -1 : 1;
            }
        }
    });
    return sides;
}

}  // namespace tessera
