#include "render/geometry_builder.h"

#include <gtest/gtest.h>

#include <map>

#include "mapping/analytic_fields.h"
#include "render/vertex_weight.h"

namespace tessera {
namespace {

using namespace testing_support;

// A sphere that covers many blocks in every octant.
class GeometryBuilderTest : public ::testing::Test {
  protected:
    GeometryBuilderTest() {
        Fill(map, Sphere({.01, -.02, .03}, .2), {-4, -4, -4}, {4, 4, 4});
        for (BlockId id = 1; id < map.size(); ++id)
            for (int i = 0; i < kBlockVoxels; ++i) map.weight(id)[i] = WeightOf(map.coord(id), i);
        mesher.Update(map);
    }
    static std::uint16_t WeightOf(const BlockCoord& c, int i) {
        return static_cast<std::uint16_t>(
            Mix(static_cast<std::uint32_t>(((c.x * 64 + c.y) * 64 + c.z) * 512 + i)));
    }
    void Take() {
        for (GeometryBlock& block : builder.Build(map, mesher, Mark()))
            copies[block.id] = std::move(block.geometry);
    }
    MarkVertex Mark() const {
        return [this](const BlockMesh& owner, const BlockMesh::Vertex& vertex) {
            return VertexMark{{1, 2, 3}, WeightStep(VertexWeight(map, owner, vertex))};
        };
    }
    // Compares every block with one built from scratch.
    void ExpectAllFresh(const std::string& after) {
        const auto& meshes = mesher.block_meshes();
        for (std::size_t id = 0; id < meshes.size(); ++id) {
            if (!meshes[id]) continue;
            BlockGeometry fresh;
            fresh.Build(*meshes[id], meshes, Mark());
            const auto& kept = copies[static_cast<BlockId>(id)].vertices;
            ASSERT_EQ(kept.size(), fresh.vertices.size());
            for (std::size_t i = 0; i < kept.size(); ++i)
                ASSERT_EQ(kept[i].mark.weight, fresh.vertices[i].mark.weight)
                    << after << ", block " << id << " vertex " << i;
        }
    }

    BlockMap map{BlockMap::Config{}};
    Mesher mesher{{0, 0}};
    GeometryBuilder builder;
    std::map<BlockId, BlockGeometry> copies;
};

// The expected weight follows from the vertex position alone: the two voxels it lies between, and
// the fraction.
TEST_F(GeometryBuilderTest, VerticesCarryTheWeightBetweenTheirVoxels) {
    Take();
    int checked = 0;
    for (const auto& [id, geometry] : copies)
        for (const GeometryVertex& vertex : geometry.vertices) {
            const BlockCoord sector = SectorOf(map.coord(id));
            const Eigen::Vector3d at =
                Eigen::Vector3d(sector.x, sector.y, sector.z) * kSectorBlocks * kBlockSide +
                Eigen::Vector3f(vertex.position_voxels.data()).cast<double>();
            const Eigen::Vector3d low = at.array().floor();
            const auto weight = [&](const Eigen::Vector3d& voxel) {
                const Eigen::Vector3i v = voxel.cast<int>();
                const int i = (v.x() & 7) + 8 * (v.y() & 7) + 64 * (v.z() & 7);
                return WeightOf({v.x() >> 3, v.y() >> 3, v.z() >> 3}, i) / 256.0;
            };
            const double part = (at - low).maxCoeff();
            const Eigen::Vector3d high = at.array().ceil();
            const double expected = (1 - part) * weight(low) + part * weight(high);
            ASSERT_NEAR(vertex.mark.weight, 255 / 8.0 * std::log2(1 + expected), 0.6);
            ASSERT_EQ(vertex.mark.label_colour, (Rgb8{1, 2, 3}));
            ++checked;
        }
    EXPECT_GT(checked, 5000);
}

TEST(VertexWeight, TheScaleIsLogarithmic) {
    EXPECT_EQ(WeightStep(0), 0);
    EXPECT_EQ(WeightStep(1), 32);    // 31.875
    EXPECT_EQ(WeightStep(15), 128);  // 127.5
    EXPECT_EQ(WeightStep(255), 255);
    EXPECT_EQ(WeightStep(1e9f), 255);
}

// If only the marks of one block's voxels change, all copies of the vertices near them are rebuilt,
// but not the whole mesh.
TEST_F(GeometryBuilderTest, MarkedAgainWithoutMeshingAgain) {
    Take();
    const std::size_t all = copies.size();
    mesher.Update(map);
    ASSERT_TRUE(builder.Build(map, mesher, Mark()).empty());
    for (BlockId id = 1; id < map.size(); ++id) {
        for (int i = 0; i < kBlockVoxels; ++i)
            map.weight(id)[i] = static_cast<std::uint16_t>(map.weight(id)[i] + 7000);
        builder.MarkAgain({&id, 1});
        const auto blocks = builder.Build(map, mesher, Mark());
        EXPECT_LT(blocks.size(), all / 2);
        for (GeometryBlock& block : blocks) copies[block.id] = std::move(block.geometry);
        ASSERT_NO_FATAL_FAILURE(ExpectAllFresh("after block " + std::to_string(id)));
    }
    EXPECT_TRUE(builder.Build(map, mesher, Mark()).empty());
    const BlockId first = 1;
    builder.MarkAgain({&first, 1});
    builder.Clear();
    EXPECT_TRUE(builder.Build(map, mesher, Mark()).empty());
}

}  // namespace
}  // namespace tessera
