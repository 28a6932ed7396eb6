#include "mapping/mesh_assembly.h"

#include <tbb/parallel_for.h>

#include <limits>
#include <numeric>

#include "core/check.h"

namespace tessera {
namespace {

using Blocks = std::vector<std::unique_ptr<const BlockMesh>>;
using Triangles = std::vector<std::array<std::uint32_t, 3>>;

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

// Index of each block's first vertex and first triangle, plus one entry for the end.
struct FirstIndices {
    std::vector<std::uint32_t> vertex, triangle;

    explicit FirstIndices(const Blocks& blocks) : vertex(1, 0), triangle(1, 0) {
        std::size_t vertices = 0, triangles = 0;
        for (const auto& block : blocks) {
            if (block) {
                vertices += block->vertices.size();
                triangles += block->triangles.size();
            }
            TESSERA_CHECK(vertices < kNone && triangles < kNone, "{} vertices, {} triangles",
                          vertices, triangles);
            vertex.push_back(static_cast<std::uint32_t>(vertices));
            triangle.push_back(static_cast<std::uint32_t>(triangles));
        }
    }
};

template <class Body>
void ForEachBlock(const Blocks& blocks, const Body& body) {
    tbb::parallel_for(std::size_t{0}, blocks.size(), [&](std::size_t id) {
        if (blocks[id]) body(id, *blocks[id]);
    });
}

std::uint32_t Resolve(const Blocks& blocks, const BlockMesh& block, BlockMesh::VertexRef ref,
                      const std::vector<std::uint32_t>& first_vertex) {
    const auto id = static_cast<std::size_t>(block.blocks[ref >> BlockMesh::kSlotShift]);
    if (!blocks[id]) return kNone;
    const int found = blocks[id]->FindVertex(ref & ((1 << BlockMesh::kSlotShift) - 1));
    return found < 0 ? kNone : first_vertex[id] + static_cast<std::uint32_t>(found);
}

// Triangles over global vertex indices, ordered by block.
Triangles ResolveTriangles(const Blocks& blocks, const FirstIndices& first) {
    Triangles triangles(first.triangle.back());
    ForEachBlock(blocks, [&](std::size_t id, const BlockMesh& block) {
        for (std::size_t t = 0; t < block.triangles.size(); ++t)
            for (std::size_t i = 0; i < 3; ++i)
                triangles[first.triangle[id] + t][i] =
                    Resolve(blocks, block, block.triangles[t][i], first.vertex);
    });
    std::erase_if(triangles,
                  [](const auto& t) { return t[0] == kNone || t[1] == kNone || t[2] == kNone; });
    return triangles;
}

// Union-find over vertices; a root is its component's smallest index.
class Components {
  public:
    Components(std::size_t vertices, const Triangles& triangles) : parent_(vertices) {
        std::iota(parent_.begin(), parent_.end(), 0u);
        for (const auto& [a, b, c] : triangles) {
            Join(a, b);
            Join(a, c);
        }
    }
    std::uint32_t Root(std::uint32_t v) {
        while (parent_[v] != v) v = parent_[v] = parent_[parent_[v]];
        return v;
    }

  private:
    void Join(std::uint32_t a, std::uint32_t b) {
        a = Root(a);
        b = Root(b);
        (a < b ? parent_[b] : parent_[a]) = std::min(a, b);
    }
    std::vector<std::uint32_t> parent_;
};

void DropSmallComponents(Triangles& triangles, std::size_t vertices, int min_triangles) {
    if (min_triangles <= 1) return;
    Components components(vertices, triangles);
    std::vector<int> size(vertices, 0);
    for (const auto& t : triangles) ++size[components.Root(t[0])];
    std::erase_if(triangles,
                  [&](const auto& t) { return size[components.Root(t[0])] < min_triangles; });
}

// The new index of each vertex, counting only those in use; kNone for the others. Renumbers the
// triangles.
std::vector<std::uint32_t> Compact(Triangles& triangles, std::size_t vertices,
                                   std::uint32_t& count) {
    std::vector<std::uint32_t> index(vertices, kNone);
    for (const auto& t : triangles)
        for (const std::uint32_t v : t) index[v] = 0;
    count = 0;
    for (std::uint32_t& i : index)
        if (i != kNone) i = count++;
    for (auto& t : triangles)
        for (std::uint32_t& v : t) v = index[v];
    return index;
}

}  // namespace

TriangleMesh AssembleMesh(const Blocks& blocks, double voxel_size_m, int min_component_triangles,
                          const BlockVertexLabels& labels) {
    const FirstIndices first(blocks);
    const std::size_t vertices = first.vertex.back();
    TriangleMesh mesh;
    mesh.triangles = ResolveTriangles(blocks, first);
    DropSmallComponents(mesh.triangles, vertices, min_component_triangles);
    std::uint32_t used = 0;
    const std::vector<std::uint32_t> index = Compact(mesh.triangles, vertices, used);
    mesh.vertices.resize(used);
    mesh.normals.resize(used);
    mesh.colours.resize(used);
    mesh.labels.resize(labels.empty() ? 0 : used);
    ForEachBlock(blocks, [&](std::size_t id, const BlockMesh& block) {
        for (std::size_t i = 0; i < block.vertices.size(); ++i) {
            const std::uint32_t v = index[first.vertex[id] + i];
            if (v == kNone) continue;
            mesh.vertices[v] = VertexPosition(block, block.vertices[i], voxel_size_m);
            mesh.normals[v] = VertexNormal(block.vertices[i]);
            mesh.colours[v] = block.vertices[i].colour;
            if (!labels.empty() && !labels[id].empty()) mesh.labels[v] = labels[id][i];
        }
    });
    return mesh;
}

}  // namespace tessera
