// The surface inside one block: marching cubes over the block's 8 x 8 x 8 cells, stored compactly.
// Triangles refer to neighbouring blocks for vertices that those own. Mesher keeps one BlockMesh
// per block and joins them.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "core/config.h"
#include "mapping/block_map.h"
#include "mapping/mesh_kernels.h"

namespace tessera {

struct MeshConfig {
    double min_weight = 0;  // minimum weight of all eight corners of a cell
    // smaller connected components are dropped from the whole mesh
    int min_component_triangles = 30;

    void Describe(ConfigParameters& parameters);
};

// A cell belongs to the block of its lowest corner; its other corners may lie in the seven positive
// neighbours. A vertex belongs to the block of its edge's lower end, so each vertex exists once.
struct BlockMesh {
    static constexpr int kSlotShift = kMeshSlotShift;
    using VertexRef = MeshVertexRef;
    using Vertex = MeshVertex;

    BlockCoord coord;
    std::array<BlockId, 8> blocks{};  // by slot; slot 0 is this block
    std::vector<Vertex> vertices;     // in increasing order of edge
    std::vector<std::array<VertexRef, 3>> triangles;

    // Index of the vertex on `edge`, or -1.
    int FindVertex(int edge) const;
    std::size_t bytes() const;  // on the heap, this struct included
};

// World frame, metres. [D18] eq. 8.
Eigen::Vector3f VertexPosition(const BlockMesh& mesh, const BlockMesh::Vertex& vertex,
                               double voxel_size_m);
// Unit normal, pointing out of the surface (towards positive distance).
Eigen::Vector3f VertexNormal(const BlockMesh::Vertex& vertex);

// Offsets of the blocks whose voxels a block's mesh is made from (see ReadByMesh).
inline constexpr int kMeshReads = 17;
extern const std::array<std::array<int, 3>, kMeshReads> kMeshReadOffsets;

// What a mesh asks of a voxel: at least this weight.
CellLimits MakeCellLimits(double min_weight, const BlockMap::Config& map);

// Meshes one block. Uses only cells whose corners all have a distance and enough weight. Skips
// cells in which the field falls across a whole band: there it jumps from free space to behind
// another surface. Returns null if the block has no vertex and no triangle. Thread-safe
// while nobody writes the map.
std::unique_ptr<const BlockMesh> MeshBlock(const BlockMap& map, BlockId id, double min_weight);

}  // namespace tessera
