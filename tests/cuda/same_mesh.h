// Compares block meshes byte by byte.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <span>

#include "mapping/block_mesher.h"

namespace tessera::testing_support {

static_assert(sizeof(MeshVertex) == 12, "else it has bytes that nobody writes");

// Expects the meshes of `blocks` to equal those of MeshBlock, and all others to be null. Returns
// the number of triangles.
inline std::size_t ExpectMeshesOf(const BlockMap& map, std::span<const BlockId> blocks,
                                  double min_weight, const BlockMeshes& meshes) {
    std::size_t triangles = 0;
    for (BlockId id = 0; id < map.size(); ++id) {
        const BlockMesh* mesh = meshes[static_cast<std::size_t>(id)].get();
        std::unique_ptr<const BlockMesh> expected;
        if (std::find(blocks.begin(), blocks.end(), id) != blocks.end())
            expected = MeshBlock(map, id, min_weight);
        EXPECT_EQ(mesh == nullptr, expected == nullptr) << "block " << id;
        if (mesh == nullptr || expected == nullptr) continue;
        EXPECT_EQ(mesh->coord, expected->coord) << "block " << id;
        EXPECT_EQ(mesh->blocks, expected->blocks) << "block " << id;
        EXPECT_EQ(mesh->triangles, expected->triangles) << "block " << id;
        EXPECT_EQ(mesh->vertices.size(), expected->vertices.size()) << "block " << id;
        triangles += mesh->triangles.size();
        if (mesh->vertices.size() != expected->vertices.size() || mesh->vertices.empty()) continue;
        EXPECT_EQ(std::memcmp(mesh->vertices.data(), expected->vertices.data(),
                              mesh->vertices.size() * sizeof(MeshVertex)),
                  0)
            << "block " << id;
    }
    return triangles;
}

}  // namespace tessera::testing_support
