#include "render/block_geometry.h"

#include <gtest/gtest.h>

#include "mapping/analytic_fields.h"
#include "mapping/mesher.h"

namespace tessera {
namespace {

using namespace testing_support;

Eigen::Vector3d WorldPosition(const GeometryVertex& vertex, const BlockCoord& block) {
    const BlockCoord sector = SectorOf(block);
    const auto& p = vertex.position_voxels;
    return .01 * (Eigen::Vector3d(sector.x, sector.y, sector.z) * kSectorBlocks * kBlockSide +
                  Eigen::Vector3f(p[0], p[1], p[2]).cast<double>());
}

// Together the blocks equal the mesh assembled by Mesher, across blocks, sectors and signs.
TEST(BlockGeometry, TogetherTheBlocksAreTheWholeMesh) {
    for (const Eigen::Vector3d& centre :
         {Eigen::Vector3d(.011, -.023, .031), Eigen::Vector3d(10.24, .0, -10.24)}) {
        BlockMap map{BlockMap::Config{}};
        const Eigen::Vector3i middle = (centre / .08).array().round().cast<int>();
        Fill(map, Sphere(centre, .2), {middle.x() - 4, middle.y() - 4, middle.z() - 4},
             {middle.x() + 4, middle.y() + 4, middle.z() + 4},
             [](const Eigen::Vector3d&) { return Eigen::Vector3d(.2, .4, .6); });
        Mesher mesher({0, 0});
        mesher.Update(map);
        const TriangleMesh whole = mesher.Assemble();
        BlockGeometry geometry;
        std::size_t next = 0;  // both are ordered by block, then by triangle
        for (const auto& mesh : mesher.block_meshes()) {
            if (!mesh) continue;
            geometry.Build(*mesh, mesher.block_meshes());
            const auto& [vertices, indices] = geometry;
            for (std::size_t i = 0; i < indices.size(); ++i, ++next) {
                ASSERT_LT(next / 3, whole.triangles.size());
                const Eigen::Vector3f& expected =
                    whole.vertices[whole.triangles[next / 3][next % 3]];
                ASSERT_LT(
                    (WorldPosition(vertices[indices[i]], mesh->coord) - expected.cast<double>())
                        .norm(),
                    2e-6);
            }
            for (const GeometryVertex& vertex : vertices) {
                ASSERT_EQ(vertex.has_colour, 255);
                ASSERT_NEAR(vertex.colour.b, .6 * 255, 1);
            }
        }
        EXPECT_GT(next, 15000u);
        EXPECT_EQ(next, 3 * whole.triangles.size());
    }
}

TEST(BlockGeometry, WithoutTheNeighbourItsTrianglesAreLeftOut) {
    BlockMap map{BlockMap::Config{}};
    Fill(map, Plane({0, 0, 1}, .035), {0, 0, 0}, {1, 0, 0});
    Mesher mesher({0, 0});
    mesher.Update(map);
    const BlockMesh& mesh = *mesher.block_meshes()[static_cast<std::size_t>(map.Find({0, 0, 0}))];
    BlockGeometry geometry;
    geometry.Build(mesh, mesher.block_meshes());
    // The last row of cells has no neighbour block in y.
    EXPECT_EQ(geometry.indices.size(), 3u * 2 * 8 * 7);
    EXPECT_EQ(geometry.vertices.front().has_colour, 0);
    geometry.Build(mesh, {});
    EXPECT_EQ(geometry.indices.size(), 3u * 2 * 7 * 7);
    geometry.Build(mesh, mesher.block_meshes());  // nothing is left over from the previous call
    EXPECT_EQ(geometry.indices.size(), 3u * 2 * 8 * 7);
}

TEST(BlockGeometry, SectorsFloor) {
    EXPECT_EQ(SectorOf({0, 127, 128}), (BlockCoord{0, 0, 1}));
    EXPECT_EQ(SectorOf({-1, -128, -129}), (BlockCoord{-1, -1, -2}));
}

}  // namespace
}  // namespace tessera
