#include "mapping/mesh_kernels.h"

#include <gtest/gtest.h>

#include <vector>

#include "mapping/block_mesh.h"

namespace tessera {
namespace {

FieldWord Word(float distance, std::uint32_t intensity = 0) {
    return static_cast<std::uint32_t>(static_cast<std::int32_t>(distance * kDistanceSteps)) << 16 |
           intensity;
}

// Distance 0.1 (x - 2.25) + 0.2 (y - 2): in row y = 2 the surface crosses at x = 2.25.
std::vector<FieldWord> Slanted() {
    std::vector<FieldWord> words;
    for (int z = 0; z < ApronField::kSide; ++z)
        for (int y = 0; y < ApronField::kSide; ++y)
            for (int x = 0; x < ApronField::kSide; ++x) {
                const float d = 0.1f * (static_cast<float>(x - 1) - 2.25f) +
                                0.2f * static_cast<float>(y - 1 - 2);
                words.push_back(Word(d, 1 + 32768));
            }
    return words;
}

TEST(MeshKernels, VertexLiesAtTheZeroWithTheGradientsNormal) {
    const std::vector<FieldWord> words = Slanted();
    const MeshVertex v = VertexOnEdge({words.data()}, 0, 2, 2, 3, kNoColour, kNoColour);
    EXPECT_NEAR(v.fraction, 0.25 * 65536, 40);
    EXPECT_LT((VertexNormal(v) - Eigen::Vector3f(1, 2, 0).normalized()).norm(), 1e-3f);
    EXPECT_EQ(v.has_colour, 1);
    EXPECT_EQ(v.colour, (Rgb8{128, 128, 128}));
}

TEST(MeshKernels, GradientsAreOneSidedBesideTheUnknown) {
    std::vector<FieldWord> words = Slanted();
    for (const int x : {1, 4}) words[ApronField::Index(x, 2, 3)] = kUnknownField;
    for (const int y : {1, 3})
        for (const int x : {2, 3}) words[ApronField::Index(x, y, 3)] = kUnknownField;
    const MeshVertex v = VertexOnEdge({words.data()}, 0, 2, 2, 3, kNoColour, kNoColour);
    EXPECT_LT((VertexNormal(v) - Eigen::Vector3f(1, 0, 0)).norm(), 1e-3f)
        << "the gradient in y is unknown";
}

TEST(MeshKernels, ColourIsTheOtherEndsWhereOneHasNone) {
    const FieldWord white = Word(-0.1f, 1 + 65534), none = Word(0.1f), black = Word(0.1f, 1);
    EXPECT_EQ(MixColours(white, kNoColour, none, 0, 0.7f), (Rgb8{255, 255, 255}));
    EXPECT_EQ(MixColours(none, 0, white, kNoColour, 0.7f), (Rgb8{255, 255, 255}));
    EXPECT_EQ(MixColours(white, kNoColour, black, kNoColour, 0.2f), (Rgb8{204, 204, 204}));
    EXPECT_EQ(MixColours(none, 0, none, 0, 0.5f), (Rgb8{128, 128, 128}));
}

TEST(MeshKernels, NormalsSurviveTheirCode) {
    for (const float x : {-0.9f, -0.1f, 0.0f, 0.6f})
        for (const float y : {-0.5f, 0.0f, 0.8f})
            for (const float z : {-1.0f, -0.2f, 0.3f}) {
                const float n[3] = {3 * x, 3 * y, 3 * z};
                MeshVertex v{};
                EncodeNormal(n, v.normal.data());
                const Eigen::Vector3f expected = Eigen::Vector3f(x, y, z).normalized();
                EXPECT_LT((VertexNormal(v) - expected).norm(), 2e-4f) << expected.transpose();
            }
}

}  // namespace
}  // namespace tessera
