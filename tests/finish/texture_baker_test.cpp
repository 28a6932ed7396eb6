#include "finish/texture_baker.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "finish/meshes.h"
#include "finish/wall_frames.h"

namespace tessera {
namespace {

using testing_support::Square;
using testing_support::WallCamera;
using testing_support::WallFrame;
using testing_support::WallPaint;

class BakedWall : public testing::Test {
  protected:
    BakedWall() : mesh(Square({-0.25f, -0.25f, 0}, {1, 0, 0}, {0, 1, 0}, 0.5f, 12)) {
        charts = CutCharts(mesh, {.cell_m = 0.004});
        const Result<Atlas> packed = PackCharts(charts, 0.004, 1024);
        if (packed.ok()) atlas = packed.value();
    }
    // Largest difference from the paint over the places of the wall.
    float WorstError(const ColourImage& texture) const {
        float worst = 0;
        for (float x = -0.24f; x < 0.25f; x += 0.01f)
            for (float y = -0.24f; y < 0.25f; y += 0.01f) {
                const Eigen::Vector2f at = atlas.TexelOf(charts[0], 0, {x, y, 0});
                const Eigen::Vector2i texel = at.array().round().cast<int>();
                const Eigen::Vector2f off = (texel.cast<float>() - at) * 0.004f;
                const Eigen::Vector3f there =
                    Eigen::Vector3f(x, y, 0) + off.x() * charts[0].right + off.y() * charts[0].down;
                const Rgb8 c = texture(texel.x(), texel.y());
                worst = std::max(worst,
                                 (Eigen::Array3f(c.r, c.g, c.b) - WallPaint(there.x(), there.y()))
                                     .abs()
                                     .maxCoeff());
            }
        return worst;
    }

    TriangleMesh mesh;
    std::vector<Chart> charts;
    Atlas atlas;
};

TEST_F(BakedWall, HasThePaintOnIt) {
    TextureBaker baker(mesh, charts, atlas);
    EXPECT_EQ(baker.SeenShare(), 0);
    baker.Add(MakeTextureView(WallCamera(), WallFrame({-0.1, 0, -0.9}, 0.1), {}));
    baker.Add(MakeTextureView(WallCamera(), WallFrame({0.2, 0.1, -0.8}, -0.2), {}));
    EXPECT_GT(baker.SeenShare(), 0.99);
    EXPECT_LT(WorstError(baker.Texture()), 3);
}

TEST_F(BakedWall, ExposuresAreMadeEqual) {
    TextureBaker baker(mesh, charts, atlas);
    TextureView bright = MakeTextureView(WallCamera(), WallFrame({-0.1, 0, -0.9}, 0.1), {}),
                dark = MakeTextureView(
                    WallCamera(), WallFrame({0.2, 0.1, -0.8}, -0.2, Eigen::Array3f::Constant(0.6f)),
                    {});
    dark.gain.setConstant(1 / 0.6f);
    baker.Add(bright);
    baker.Add(dark);
    EXPECT_LT(WorstError(baker.Texture()), 4);
}

TEST_F(BakedWall, WhatNoViewShowsHasTheMeshsColourAndTheRestTheMean) {
    TextureBaker baker(mesh, charts, atlas);
    baker.Add(MakeTextureView(WallCamera(), WallFrame({5, 0, -0.9}, 0), {}));
    EXPECT_EQ(baker.SeenShare(), 0);
    const ColourImage texture = baker.Texture();
    for (std::size_t i = 0; i < texture.size(); ++i)
        EXPECT_EQ(texture.data()[i], (Rgb8{128, 128, 128}));
}

// A bilinear filter at the rim reads only texels that were filled.
TEST_F(BakedWall, TheGutterIsFilled) {
    TextureBaker baker(mesh, charts, atlas);
    baker.Add(MakeTextureView(WallCamera(), WallFrame({0, 0, -0.9}, 0), {}));
    const ColourImage texture = baker.Texture();
    const Rgb8 between = texture(atlas.width - 1, atlas.height - 1);
    for (const Eigen::Vector3f& p : mesh.vertices) {
        const Eigen::Vector2f at = atlas.TexelOf(charts[0], 0, p);
        for (const int dx : {0, 1})
            for (const int dy : {0, 1}) {
                const int x = static_cast<int>(std::floor(at.x())) + dx,
                          y = static_cast<int>(std::floor(at.y())) + dy;
                ASSERT_TRUE(texture.Contains(x, y));
                EXPECT_FALSE(texture(x, y) == between) << x << " " << y;
            }
    }
}

TEST_F(BakedWall, TheSameBytesForAnyNumberOfThreads) {
    ColourImage first;
    for (const std::size_t threads : {1u, 3u}) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
        TextureBaker baker(mesh, charts, atlas);
        baker.Add(MakeTextureView(WallCamera(), WallFrame({-0.1, 0, -0.9}, 0.1), {}));
        baker.Add(MakeTextureView(WallCamera(), WallFrame({0.2, 0.1, -0.8}, -0.2), {}));
        if (first.empty()) first = baker.Texture();
        EXPECT_EQ(baker.Texture(), first);
    }
}

}  // namespace
}  // namespace tessera
