#include "mapping/block_mesh.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include "mapping/cell_bits.h"
#include "mapping/marching_cubes_tables.h"

namespace tessera {
namespace {

// ---- The block's field with its apron, so that gradients need no look-ups.

class LocalField {
  public:
    LocalField(const BlockMap& map, BlockId id) {
        BlockId ids[3][3][3] = {};  // [z][y][x]; blocks that are not read stay unknown
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
        const VoxelPlace next = PlaceOf(x + (axis == 0), y + (axis == 1), z + (axis == 2));
        return VertexOnEdge(field_.view(), axis, x, y, z,
                            map_.colour(blocks_[0])[PlaceOf(x, y, z).offset],
                            map_.colour(blocks_[next.slot])[next.offset]);
    }

  private:
    const BlockMap& map_;
    const std::array<BlockId, 8>& blocks_;
    LocalField field_;
};

void MakeVertices(const BlockMap& map, BlockId id, const CellRows& rows, BlockMesh& mesh) {
    const VertexMaker maker(map, id, mesh.blocks);
    for (int axis = 0; axis < 3; ++axis)
        for (int z = 0; z < kBlockSide; ++z)
            for (int y = 0; y < kBlockSide; ++y)
                for (std::uint32_t row = rows.CrossedEdges(axis, y, z); row != 0; row &= row - 1)
                    mesh.vertices.push_back(maker.Make(axis, std::countr_zero(row), y, z));
}

// ---- Triangles.

void MakeTriangles(const CellRows& rows, BlockMesh& mesh) {
    const auto& cases = CubeCases();
    for (int z = 0; z < kBlockSide; ++z)
        for (int y = 0; y < kBlockSide; ++y)
            for (std::uint32_t row = rows.SurfaceCells(y, z); row != 0; row &= row - 1) {
                const int x = std::countr_zero(row);
                const CubeCase& cell = cases[rows.Configuration(x, y, z)];
                for (int t = 0; t < cell.triangle_count; ++t) {
                    const auto& [a, b, c] = cell.triangles[t];
                    mesh.triangles.push_back({VertexRefOf(a, x, y, z), VertexRefOf(b, x, y, z),
                                              VertexRefOf(c, x, y, z)});
                }
            }
}

constexpr auto FindReadOffsets() {
    std::array<std::array<int, 3>, kMeshReads> offsets{};
    std::size_t count = 0;
    for (int z = -1; z <= 1; ++z)
        for (int y = -1; y <= 1; ++y)
            for (int x = -1; x <= 1; ++x)
                if (ReadByMesh(x, y, z)) offsets[count++] = {x, y, z};
    return offsets;
}

}  // namespace

constexpr std::array<std::array<int, 3>, kMeshReads> kMeshReadOffsets = FindReadOffsets();

void MeshConfig::Describe(ConfigParameters& p) {
    p.Add("min_weight", min_weight, {0, kMaxWeight}, "",
          "minimum weight of the voxels that form the mesh; raise it to leave out surfaces that "
          "were seen only once or poorly");
    p.Add("min_component_triangles", min_component_triangles, {0, 1e9}, "",
          "connected components with fewer triangles are left out of the written mesh; 0 keeps "
          "all, higher values remove larger floating specks");
}

CellLimits MakeCellLimits(double min_weight, const BlockMap::Config& map) {
    // Fused averages rarely reach the end of the band exactly.
    constexpr double kNearlyAll = 0.99;
    return {static_cast<int>(std::ceil(min_weight * kWeightSteps)),
            static_cast<int>(kNearlyAll * map.truncation_m / map.range_m() * kDistanceSteps)};
}

std::unique_ptr<const BlockMesh> MeshBlock(const BlockMap& map, BlockId id, double min_weight) {
    // Kept between calls to reuse its storage; the result is a copy of minimal size.
    thread_local BlockMesh scratch;
    std::copy_n(map.view().neighbours + 8 * static_cast<std::size_t>(id), 8,
                scratch.blocks.begin());
    const CellBits bits(map, scratch.blocks, MakeCellLimits(min_weight, map.config()));
    if (!bits.HasBothSigns()) return nullptr;
    scratch.coord = map.coord(id);
    scratch.vertices.clear();
    scratch.triangles.clear();
    MakeVertices(map, id, bits.view(), scratch);
    MakeTriangles(bits.view(), scratch);
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
