#include "mapping/block_mesh.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include "mapping/cell_bits.h"
#include "mapping/marching_cubes_tables.h"
#include "mapping/mesh_kernels.h"

namespace tessera {
namespace {

// ---- The block's field with its apron, so that gradients need no look-ups.

class LocalField {
  public:
    LocalField(const BlockMap& map, BlockId id) {
        BlockId ids[3][3][3] = {};  // [z][y][x]; what is not read stays unknown
        for (const auto& [dx, dy, dz] : kMeshReadOffsets)
            ids[dz + 1][dy + 1][dx + 1] = map.neighbour(id, dx, dy, dz);
        FieldWord* out = words_;
        for (int z = -1; z < 10; ++z)
            for (int y = -1; y < 10; ++y, out += 11) {
                const BlockId* row = ids[(z >> 3) + 1][(y >> 3) + 1];
                const int offset = (y & 7) * 8 + (z & 7) * 64;
                out[0] = map.field(row[0])[offset + 7];
                std::memcpy(out + 1, map.field(row[1]) + offset, kBlockSide * sizeof(FieldWord));
                std::memcpy(out + 9, map.field(row[2]) + offset, 2 * sizeof(FieldWord));
            }
    }

    ApronField view() const { return {words_}; }

  private:
    FieldWord words_[ApronField::kWords];
};

// ---- Vertices.

class VertexMaker {
  public:
    VertexMaker(const BlockMap& map, BlockId id, const std::array<BlockId, 8>& blocks)
        : map_(map), blocks_(blocks), field_(map, id) {}

    BlockMesh::Vertex Make(int axis, int x, int y, int z) const {
        const int offset = x + 8 * y + 64 * z;
        int next[3] = {x, y, z};
        const bool leaves = ++next[axis] == kBlockSide;
        const BlockId next_block = blocks_[leaves ? 1 << axis : 0];
        const int next_offset = (next[0] & 7) + 8 * (next[1] & 7) + 64 * (next[2] & 7);
        const EdgeVertex v = VertexOnEdge(field_.view(), axis, x, y, z, map_.colour(blocks_[0])[offset],
                                          map_.colour(next_block)[next_offset]);
        return {static_cast<std::uint16_t>(axis * kBlockVoxels + offset), v.fraction, {v.normal[0], v.normal[1]},
                v.colour, v.has_colour};
    }

  private:
    const BlockMap& map_;
    const std::array<BlockId, 8>& blocks_;
    LocalField field_;
};

void MakeVertices(const BlockMap& map, BlockId id, const CellBits& bits, BlockMesh& mesh) {
    const VertexMaker maker(map, id, mesh.blocks);
    for (int axis = 0; axis < 3; ++axis)
        for (int z = 0; z < kBlockSide; ++z)
            for (int y = 0; y < kBlockSide; ++y)
                for (std::uint32_t row = bits.CrossedEdges(axis, y, z); row != 0; row &= row - 1)
                    mesh.vertices.push_back(maker.Make(axis, std::countr_zero(row), y, z));
}

// ---- Triangles.

BlockMesh::VertexRef RefOf(int cube_edge, int x, int y, int z) {
    const CubeEdge e = CubeEdgeAt(cube_edge);
    x += e.corner & 1;
    y += e.corner >> 1 & 1;
    z += e.corner >> 2;
    const int slot = x >> 3 | y >> 3 << 1 | z >> 3 << 2;
    const int edge = e.axis * kBlockVoxels + (x & 7) + 8 * (y & 7) + 64 * (z & 7);
    return static_cast<BlockMesh::VertexRef>(slot << BlockMesh::kSlotShift | edge);
}

void MakeTriangles(const CellBits& bits, BlockMesh& mesh) {
    const auto& cases = CubeCases();
    for (int z = 0; z < kBlockSide; ++z)
        for (int y = 0; y < kBlockSide; ++y)
            for (std::uint32_t row = bits.SurfaceCells(y, z); row != 0; row &= row - 1) {
                const int x = std::countr_zero(row);
                const CubeCase& cell = cases[bits.Configuration(x, y, z)];
                for (int t = 0; t < cell.triangle_count; ++t) {
                    const auto& [a, b, c] = cell.triangles[t];
                    mesh.triangles.push_back(
                        {RefOf(a, x, y, z), RefOf(b, x, y, z), RefOf(c, x, y, z)});
                }
            }
}

constexpr auto FindReadOffsets() {
    std::array<std::array<int, 3>, kMeshReads> offsets{};
    std::size_t count = 0;
    for (int z = -1; z <= 1; ++z)
        for (int y = -1; y <= 1; ++y)
            for (int x = -1; x <= 1; ++x) {
                const int below = (x < 0) + (y < 0) + (z < 0), above = (x > 0) + (y > 0) + (z > 0);
                if (below == 0 || (below == 1 && above <= 1)) offsets[count++] = {x, y, z};
            }
    return offsets;
}

}  // namespace

constexpr std::array<std::array<int, 3>, kMeshReads> kMeshReadOffsets = FindReadOffsets();

void MeshConfig::Describe(ConfigParameters& p) {
    p.Add(
        "min_weight", min_weight, {0, kMaxWeight}, "",
        "least weight of the voxels that a piece of mesh is made from; raise it to leave out what "
        "was seen once or badly");
    p.Add("min_component_triangles", min_component_triangles, {0, 1e9}, "",
          "connected pieces with fewer triangles are left out of the written mesh; 0 keeps all, "
          "more removes larger floating specks");
}

std::unique_ptr<const BlockMesh> MeshBlock(const BlockMap& map, BlockId id, double min_weight) {
    // Kept between calls for its storage: the result is a copy that is no larger than it needs to
    // be.
    thread_local BlockMesh scratch;
    std::copy_n(map.view().neighbours + 8 * static_cast<std::size_t>(id), 8,
                scratch.blocks.begin());
    const CellBits bits(map, scratch.blocks, min_weight);
    if (!bits.HasBothSigns()) return nullptr;
    scratch.coord = map.coord(id);
    scratch.vertices.clear();
    scratch.triangles.clear();
    MakeVertices(map, id, bits, scratch);
    MakeTriangles(bits, scratch);
    if (scratch.vertices.empty() && scratch.triangles.empty()) return nullptr;
    return std::make_unique<BlockMesh>(scratch);
}

int BlockMesh::FindVertex(int edge) const {
    const auto found = std::lower_bound(vertices.begin(), vertices.end(), edge,
                                        [](const Vertex& v, int e) { return v.edge < e; });
    if (found == vertices.end() || found->edge != edge) return -1;
    return static_cast<int>(found - vertices.begin());
}

std::size_t BlockMesh::bytes() const {
    return sizeof(*this) + vertices.capacity() * sizeof(Vertex) +
           triangles.capacity() * sizeof(triangles[0]);
}

Eigen::Vector3f VertexPosition(const BlockMesh& mesh, const BlockMesh::Vertex& vertex,
                               double voxel_size_m) {
    const int offset = vertex.edge % kBlockVoxels, axis = vertex.edge / kBlockVoxels;
    Eigen::Vector3d voxel(8.0 * mesh.coord.x + offset % 8, 8.0 * mesh.coord.y + offset / 8 % 8,
                          8.0 * mesh.coord.z + offset / 64);
    voxel[axis] += vertex.fraction / 65536.0;
    return (voxel * voxel_size_m).cast<float>();
}

Eigen::Vector3f VertexNormal(const BlockMesh::Vertex& vertex) {
    const float u = static_cast<float>(vertex.normal[0]) / 32767;
    const float v = static_cast<float>(vertex.normal[1]) / 32767;
    Eigen::Vector3f n(u, v, 1 - std::abs(u) - std::abs(v));
    if (n.z() < 0) {
        n.x() = std::copysign(1 - std::abs(v), u);
        n.y() = std::copysign(1 - std::abs(u), v);
    }
    return n.normalized();
}

}  // namespace tessera
