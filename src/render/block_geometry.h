// One block's mesh as a graphics card takes it: vertices of its own and copies of those that it
// borrows from its neighbours, so that each block is drawn by itself, with 16-bit indices.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "mapping/block_mesh.h"

namespace tessera {

// What else a person may want to see of a vertex, whatever is chosen at the moment: a window shades
// by one or the other without asking for the mesh again.
struct VertexMark {
    Rgb8 label_colour;        // of its object's class, or a grey
    std::uint8_t weight = 0;  // WeightStep of the map's weight there
};
// Of a vertex of its owner; called from many threads at once.
using MarkVertex =
    std::function<VertexMark(const BlockMesh& owner, const BlockMesh::Vertex& vertex)>;

struct GeometryVertex {
    std::array<float, 3> position_voxels;  // from its sector's origin
    std::array<std::int16_t, 2> normal;    // octahedral, unit is 32767; world frame
    Rgb8 colour;
    std::uint8_t has_colour;  // 0 or 255
    VertexMark mark;
};
static_assert(sizeof(GeometryVertex) == 24);

// The world in cubes, each with an origin of its own: positions within one fit into floats to a
// ten-thousandth of a voxel, however far from the world's origin.
inline constexpr int kSectorBlocks = 128;
inline BlockCoord SectorOf(const BlockCoord& block) {
    static_assert(kSectorBlocks == 1 << 7);
    return {block.x >> 7, block.y >> 7, block.z >> 7};
}

struct BlockGeometry {
    std::vector<GeometryVertex> vertices;
    std::vector<std::uint16_t> indices;  // three a triangle, counter-clockwise seen from outside

    // `meshes` by block id, as Mesher keeps them. A triangle with a vertex that its owner does not
    // have (yet) is left out. Positions are taken from the origin of `mesh`'s sector, also those of
    // neighbours in others. Without `mark` the marks are zero. Thread-safe for distinct geometries.
    void Build(const BlockMesh& mesh, const std::vector<std::unique_ptr<const BlockMesh>>& meshes,
               const MarkVertex& mark = {});
};

// One block of the map's mesh, for whoever keeps a copy of it by block ids.
struct GeometryBlock {
    BlockId id = 0;
    BlockCoord coord;
    BlockGeometry geometry;  // empty: no surface here (any more)
};

}  // namespace tessera
