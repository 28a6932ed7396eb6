// Which cells of a box hold surface, which are free, and of which nothing is known. The map stores
// voxels only near surfaces, so free space comes from what the cameras saw.
#pragma once

#include <cstdint>
#include <vector>

#include "core/camera.h"
#include "core/se3.h"
#include "core/status.h"
#include "export/cell_grid.h"
#include "mapping/block_map.h"

namespace tessera {

enum class CellState : std::uint8_t { kUnknown, kFree, kOccupied };

struct Occupancy {
    struct Options {
        double min_weight = 0;  // of surfaces that count, as MeshConfig::min_weight
        // Every n-th pose of the path is used, with the smallest n that leaves at most this many.
        // The time grows with it. Space that only poses in between saw stays unknown: at 30 frames
        // per second and 6000 frames, what was seen for less than a second.
        int most_views = 200;
        // Free space is not taken from surfaces further from the camera (metres along its axis).
        // Depth cameras do not measure further, so what lies before such surfaces may be unseen.
        double max_range_m = 5.0;
    };

    CellGrid grid;
    std::vector<CellState> cells;  // [z][y][x]

    CellState At(int x, int y, int z) const { return cells[grid.Index(x, y, z)]; }
};

// A cell is occupied if there is surface in it. Else it is free if its centre is in front of a
// surface in the map's band, or lies between a camera and the surface that the map shows there
// (RayCaster, at most 320 columns): nearer than all four pixels around it, each with a surface.
// Pixels without a surface say nothing. Centres behind a surface in the band are never free. All
// other cells are unknown. Uses all TBB threads; the same for any number of them. Errors: cells
// much finer than voxels, out of memory. Thread-safe while nobody writes the map.
Result<Occupancy> MakeOccupancy(const BlockMap& map, const CellGrid& grid,
                                const PinholeCamera& camera, const std::vector<StampedPose>& path,
                                const Occupancy::Options& options);

}  // namespace tessera
