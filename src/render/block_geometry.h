// One block's mesh for the GPU: its own vertices and copies of those that it borrows from its
// neighbours. So each block can be drawn by itself, with 16-bit indices.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "mapping/block_mesh.h"

namespace tessera {

// Other vertex attributes that a viewer may want to display. Every vertex carries them, so a window
// can change its shading without requesting the mesh again.
struct VertexMark {
    Rgb8 label_colour;        // colour of the object's class, or a grey
    std::uint8_t weight = 0;  // WeightStep of the map's weight at the vertex

    // For a predicted view, which needs a label and neither of the above: the label's low byte is
    // in red, its high byte in green.
    static VertexMark OfLabel(std::uint16_t label) {
        return {{static_cast<std::uint8_t>(label & 255), static_cast<std::uint8_t>(label >> 8), 0}};
    }
};
// Computes the mark of a vertex of `owner`. Called from many threads at once.
using MarkVertex =
    std::function<VertexMark(const BlockMesh& owner, const BlockMesh::Vertex& vertex)>;

struct GeometryVertex {
    std::array<float, 3> position_voxels;  // relative to its sector's origin
    std::array<std::int16_t, 2> normal;    // octahedral, 32767 = 1; world frame
    Rgb8 colour;
    std::uint8_t has_colour;  // 0 or 255
    VertexMark mark;
};
static_assert(sizeof(GeometryVertex) == 24);

// The world is divided into cubes, each with its own origin. Positions within one are accurate to a
// ten-thousandth of a voxel in floats, however far from the world's origin.
inline constexpr int kSectorBlocks = 128;
inline BlockCoord SectorOf(const BlockCoord& block) {
    static_assert(kSectorBlocks == 1 << 7);
    return {block.x >> 7, block.y >> 7, block.z >> 7};
}

struct BlockGeometry {
    std::vector<GeometryVertex> vertices;
    std::vector<std::uint16_t> indices;  // three per triangle, counter-clockwise seen from outside

    // `meshes` is indexed by block id, as in Mesher. Leaves out triangles with a vertex that its
    // owner does not have (yet). All positions are relative to the origin of `mesh`'s sector, also
    // those borrowed from neighbours in other sectors. Without `mark`, marks are zero. Thread-safe
    // for distinct geometries.
    void Build(const BlockMesh& mesh, const std::vector<std::unique_ptr<const BlockMesh>>& meshes,
               const MarkVertex& mark = {});
};

// One block of the map's mesh, for holders of a copy indexed by block id.
struct GeometryBlock {
    BlockId id = 0;
    BlockCoord coord;
    BlockGeometry geometry;  // empty if there is no surface (any more)
};

}  // namespace tessera
