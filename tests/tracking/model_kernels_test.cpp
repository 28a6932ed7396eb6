#include "tracking/model_kernels.h"

#include <gtest/gtest.h>

#include <vector>

namespace tessera {
namespace {

// 4 x 2 pixels of a wall at 1 m. The right half is 5 cm farther in the second row, and one pixel
// has no colour.
struct Images {
    std::vector<float> depth_m = {1, 1, 1.0f, 1.0f, 1, 1, 1.05f, 1.05f};
    std::vector<float> intensity = {0.1f, 0.2f, 0.5f, -1, 0.3f, 0.4f, 0.5f, 0.5f};
    std::vector<float> normal;
    Images() {
        for (int i = 0; i < 8; ++i) normal.insert(normal.end(), {i % 2 ? 0.6f : -0.6f, 0, -0.8f});
    }
    ModelImages view() const { return {depth_m.data(), normal.data(), intensity.data(), 4, 2}; }
};

TEST(ModelKernels, HalvingTakesTheMeanOfOneSurface) {
    const Images images;
    const ModelPixel left = images.view().Halved(0, 0, 0.1f),
                     right = images.view().Halved(1, 0, 0.1f);
    EXPECT_FLOAT_EQ(left.depth_m, 1);
    EXPECT_FLOAT_EQ(left.intensity, 0.25f);
    EXPECT_NEAR(left.normal[0], 0, 1e-7);
    EXPECT_FLOAT_EQ(left.normal[2], -1);
    EXPECT_FLOAT_EQ(right.depth_m, 1.025f);
    EXPECT_EQ(right.intensity, -1) << "one pixel has no colour";
    EXPECT_EQ(images.view().Halved(1, 0, 0.04f).depth_m, 0) << "a jump";
    EXPECT_EQ(images.view().Halved(1, 0, 0.04f).normal[2], 0);
}

TEST(ModelKernels, EdgesAreJumpsAndHoles) {
    Images images;
    EXPECT_FALSE(images.view().AtEdge(3, 0, 0.06f));
    EXPECT_TRUE(images.view().AtEdge(3, 0, 0.04f));
    EXPECT_FALSE(images.view().AtEdge(0, 1, 0.04f)) << "the image border is no edge";
    images.depth_m[0] = 0;
    EXPECT_TRUE(images.view().AtEdge(0, 0, 1.0f));
    EXPECT_TRUE(images.view().AtEdge(0, 1, 1.0f));
    EXPECT_FALSE(images.view().AtEdge(1, 1, 1.0f));
}

}  // namespace
}  // namespace tessera
