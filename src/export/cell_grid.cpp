#include "export/cell_grid.h"

#include <fmt/format.h>

namespace tessera {
namespace {

Status CheckSize(const Eigen::Vector3d& size) {
    if (size.prod() <= static_cast<double>(kMostCells)) return Status::Ok();
    return Status::Error(
        fmt::format("{:.0f} x {:.0f} x {:.0f} cells are more than {}; take a smaller box or a "
                    "coarser resolution",
                    size.x(), size.y(), size.z(), kMostCells));
}

}  // namespace

Result<CellGrid> MakeGrid(const Eigen::AlignedBox3d& box_m, double resolution_m,
                          const Eigen::Isometry3d& T_world_grid) {
    constexpr double kFarthest_m = 1e5;  // indices fit into 32 bits
    if (!(resolution_m >= 0.001 && resolution_m <= 10))
        return Status::Error(
            fmt::format("a resolution of {:g} m is not within 0.001 to 10 m", resolution_m));
    // What lies on a cell's border up to rounding lies on it.
    constexpr double kRounding = 1e-6;
    const Eigen::Vector3d first = (box_m.min() / resolution_m).array() + kRounding,
                          last = (box_m.max() / resolution_m).array() - kRounding;
    const bool within =
        (box_m.min().array() >= -kFarthest_m).all() && (box_m.max().array() <= kFarthest_m).all();
    if (!within || !((last - first).minCoeff() > 0))
        return Status::Error(
            "the box is empty or not finite; its maximum must be above its minimum, both within "
            "100 km");
    const Eigen::Vector3d low = first.array().floor(), high = last.array().ceil();
    if (Status status = CheckSize(high - low); !status.ok()) return status;
    return CellGrid{T_world_grid, low.cast<int>(), (high - low).cast<int>(), resolution_m};
}

Result<CellGrid> Padded(const CellGrid& grid, int margin) {
    const Eigen::Vector3d size = grid.size.cast<double>().array() + 2.0 * margin;
    if (Status status = CheckSize(size); !status.ok()) return status;
    return CellGrid{grid.T_world_grid, grid.first.array() - margin, size.cast<int>(),
                    grid.resolution_m};
}

Eigen::AlignedBox3d BoundsOf(const BlockMap& map, const Eigen::Isometry3d& T_world_grid) {
    const double voxel_m = map.config().voxel_size_m;
    const Eigen::Matrix3d R_grid_world = T_world_grid.linear().transpose();
    const Eigen::Vector3d half_m =
        R_grid_world.cwiseAbs() * Eigen::Vector3d::Constant(0.5 * kBlockSide * voxel_m);
    const Eigen::Isometry3d T_grid_world = T_world_grid.inverse();
    Eigen::AlignedBox3d box;
    for (BlockId id = 1; id < map.size(); ++id) {
        if (map.IsFree(id)) continue;
        const BlockCoord c = map.coord(id);
        const Eigen::Vector3d middle =
            T_grid_world * (voxel_m * (kBlockSide * Eigen::Vector3d(c.x, c.y, c.z) +
                                       Eigen::Vector3d::Constant(0.5 * (kBlockSide - 1))));
        box.extend(Eigen::AlignedBox3d(middle - half_m, middle + half_m));
    }
    return box;
}

}  // namespace tessera
