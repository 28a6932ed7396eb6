// The surface inside one block: marching cubes over the block's 8 x 8 x 8 cells, stored compactly
// and referring to neighbouring blocks for the vertices that those own. Mesher keeps one per block
// and joins them.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "core/config.h"
#include "mapping/block_map.h"
#include "mapping/mesh_kernels.h"

namespace tessera {

struct MeshConfig {
    double min_weight = 0;             // of all eight corners of a cell
    int min_component_triangles = 30;  // smaller connected pieces are left out of the whole mesh

    void Describe(ConfigParameters& parameters);
};

// A cell belongs to the block of its lowest corner; its other corners may lie in the seven positive
// neighbours. A vertex belongs to the block of the lower end of its edge, so that each exists once.
struct BlockMesh {
    static constexpr int kSlotShift = kMeshSlotShift;
    using VertexRef = MeshVertexRef;
    using Vertex = MeshVertex;

    BlockCoord coord;
    std::array<BlockId, 8> blocks{};  // by slot, this one first
    std::vector<Vertex> vertices;     // in increasing order of edge
    std::vector<std::array<VertexRef, 3>> triangles;

    // The vertex on `edge`, or -1.
    int FindVertex(int edge) const;
    std::size_t bytes() const;  // on the heap, this struct included
};

// In metres, world frame. [D18] eq. 8.
Eigen::Vector3f VertexPosition(const BlockMesh& mesh, const BlockMesh::Vertex& vertex,
                               double voxel_size_m);
// Unit, out of the surface (towards positive distance).
Eigen::Vector3f VertexNormal(const BlockMesh::Vertex& vertex);

// The blocks whose voxels a block's mesh is made from, as offsets: those that are ReadByMesh.
inline constexpr int kMeshReads = 17;
extern const std::array<std::array<int, 3>, kMeshReads> kMeshReadOffsets;

// The weight that a voxel must have at least, as CellFlags counts it.
int MinWeightSteps(double min_weight);

// Meshes one block. Only cells whose corners all have a distance and enough weight take part, and
// not those that hold both ends of the distance's range: there the field jumps from free space to
// behind some other surface. Null if the block has no vertex and no triangle. Thread-safe while
// nobody writes the map.
std::unique_ptr<const BlockMesh> MeshBlock(const BlockMap& map, BlockId id, double min_weight);

}  // namespace tessera
