// The Euclidean distance to the nearest surface in every cell of a box (an ESDF), for planners. The
// map itself has distances only within its truncation, along the rays of the cameras.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/status.h"
#include "export/cell_grid.h"
#include "export/occupancy.h"
#include "mapping/block_map.h"

namespace tessera {

struct DistanceField {
    struct Options {
        // Surfaces up to this far from a cell count, inside and outside of the box. Cells with
        // none so near have this distance. Time and memory are those of the box with this margin
        // on each side.
        double max_distance_m = 2.0;
        double min_weight = 0;  // of surfaces that count, as MeshConfig::min_weight
    };

    CellGrid grid;
    double max_distance_m = 0;
    // Per cell, [z][y][x]: metres from its centre to the nearest surface, at most max_distance_m.
    // Negative where the map was observed to lie behind a surface, which it is up to the
    // truncation; else positive, also where nothing is known.
    std::vector<float> distance_m;
    // 1: the cell's centre was observed, by the map or as free; 0: its sign is unknown.
    std::vector<std::uint8_t> known;

    float At(int x, int y, int z) const { return distance_m[grid.Index(x, y, z)]; }
    bool Known(int x, int y, int z) const { return known[grid.Index(x, y, z)] != 0; }
};

// The distances in the cells of `grid`. `seen`, if not null, has the same grid; its free cells are
// known. The nearest of the surface's points (SurfacePoints) is found by lower envelopes of
// parabolas along x, y and z (Felzenszwalb and Huttenlocher, Distance Transforms of Sampled
// Functions, 2012), with the points' own positions in place of cell centres. Errors stay below half
// a cell: the mean is 0.03 cells. Uses all TBB threads; the same bytes for any number of them.
// Errors: a box that is too large with its margin, cells much finer than voxels, out of memory.
// Thread-safe while nobody writes the map.
Result<DistanceField> MakeDistanceField(const BlockMap& map, const CellGrid& grid,
                                        const DistanceField::Options& options,
                                        const Occupancy* seen = nullptr);

// Writes three files. `path` (.npy): float32 of shape (z, y, x), metres. NAME_known.npy: uint8 of
// the same shape. NAME.yaml, written last: shape, resolution, origin (the centre of cell [0, 0, 0],
// metres), `frame` (a name) and T_world_frame. Errors: write errors. Thread-safe for different
// paths.
Status WriteDistanceField(const std::string& path, const DistanceField& field,
                          const std::string& frame);

}  // namespace tessera
