// The shape of distance fields and occupancies: a box of cubic cells, axis-aligned in a frame of
// its own, usually the level world.
#pragma once

#include <Eigen/Geometry>
#include <cstddef>

#include "core/status.h"
#include "mapping/block_map.h"

namespace tessera {

// Cell (i, j, k), counted from 0 within the box, spans (first + (i, j, k)) * resolution_m to one
// resolution_m more along each axis of the grid frame. So two boxes with one frame and resolution
// share their cells, and indices convert to OctoMap's keys. Arrays of cells are [z][y][x].
struct CellGrid {
    Eigen::Isometry3d T_world_grid = Eigen::Isometry3d::Identity();
    Eigen::Vector3i first = Eigen::Vector3i::Zero();  // cells from the frame's origin
    Eigen::Vector3i size = Eigen::Vector3i::Zero();   // cells
    double resolution_m = 0.05;

    std::size_t cells() const {
        return static_cast<std::size_t>(size.x()) * static_cast<std::size_t>(size.y()) *
               static_cast<std::size_t>(size.z());
    }
    std::size_t Index(int x, int y, int z) const {
        return static_cast<std::size_t>(x) +
               static_cast<std::size_t>(size.x()) *
                   (static_cast<std::size_t>(y) +
                    static_cast<std::size_t>(size.y()) * static_cast<std::size_t>(z));
    }
    // The lowest corner and a cell's centre, metres in the grid frame.
    Eigen::Vector3d Low() const { return first.cast<double>() * resolution_m; }
    Eigen::Vector3d Centre(int x, int y, int z) const {
        return (first + Eigen::Vector3i(x, y, z)).cast<double>() * resolution_m +
               Eigen::Vector3d::Constant(0.5 * resolution_m);
    }
    bool operator==(const CellGrid& o) const {
        return T_world_grid.isApprox(o.T_world_grid, 0) && first == o.first && size == o.size &&
               resolution_m == o.resolution_m;
    }
};

// Larger boxes, margins included, are refused: 645 cells along each axis. A distance field takes up
// to 20 bytes a cell, 5 GB.
inline constexpr std::size_t kMostCells = std::size_t{1} << 28;

// The cells that the box (metres, grid frame) overlaps. Errors: a box that is empty or beyond 100
// km, a resolution outside 1 mm to 10 m, more than kMostCells. They do not name an option.
// Thread-safe.
Result<CellGrid> MakeGrid(const Eigen::AlignedBox3d& box_m, double resolution_m,
                          const Eigen::Isometry3d& T_world_grid);

// The box with `margin` cells more on each side. Error: more than kMostCells.
Result<CellGrid> Padded(const CellGrid& grid, int margin);

// A box (metres, grid frame) around all blocks of the map; empty for an empty map. At most a
// block's diagonal too large on each side. Thread-safe while nobody writes the map.
Eigen::AlignedBox3d BoundsOf(const BlockMap& map, const Eigen::Isometry3d& T_world_grid);

}  // namespace tessera
