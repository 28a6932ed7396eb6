// What the map's field says about a box of cells: points on the surface, and the side of the
// surface on which each cell's centre lies.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "export/cell_grid.h"
#include "mapping/block_map.h"

namespace tessera {

// Cells may be as small as this part of a voxel. Smaller ones show nothing more.
inline constexpr double kFinestCell = 0.25;

// Error: cells below kFinestCell of a voxel.
Status CheckResolution(const CellGrid& grid, const BlockMap::Config& map);

// Points on the surface within the box, in cells from its lowest corner; at most half a cell (and
// at most a voxel) apart along the surface. They are zero crossings of the trilinear field along
// the edges between voxels, and between them where cells are smaller than two voxels. The surface
// is the mesher's: all eight voxels around it are known and have at least `min_weight`
// (MeshConfig), and occlusion edges do not count. Maps without weights need min_weight 0.
// Uses all TBB threads; the points and their order are the same for any number. Requires
// CheckResolution. Thread-safe while nobody writes.
std::vector<Eigen::Vector3f> SurfacePoints(const BlockMap& map, const CellGrid& grid,
                                           double min_weight);

// Per cell, [z][y][x], the sign of the trilinear field at its centre: 1 in front of the surface, -1
// behind it, 0 where one of the eight voxels around it was never measured. Parallel and thread-safe
// like SurfacePoints.
std::vector<std::int8_t> ObservedSides(const BlockMap& map, const CellGrid& grid);

}  // namespace tessera
