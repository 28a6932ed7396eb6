// Compares the SIMD fusion with the same kernels applied one voxel at a time.
#include "mapping/fusion_simd.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "core/cpu.h"
#include "core/scalar_lanes.h"
#include "mapping/fusion_kernels.h"

namespace tessera {
namespace {

constexpr int kWidth = 97, kHeight = 61, kBlocks = 64;

// Blocks of random voxels in front of a camera, and a frame of random pixels. A fifth of the pixels
// have no depth.
struct Scene {
    std::vector<FieldWord> field;
    std::vector<std::uint16_t> weight;
    std::vector<ColourWord> colour;
    std::vector<std::int32_t> coords, blocks;
    std::vector<float> depth_m, gone_m;
    std::vector<std::uint32_t> packed_colour;
    FusionArguments a{};
    bool gone = false;  // whether gone_m is passed on

    Scene() {
        std::uint32_t state = 4711;
        const auto random = [&state] {
            state = state * 1664525u + 1013904223u;
            return state ^ state >> 16;
        };
        for (std::int32_t i = 0; i < kBlocks; ++i) {
            blocks.push_back(i);
            coords.insert(coords.end(), {i % 4 - 2, i / 4 % 4 - 2, 2 + i / 16, i + 100});
            for (int k = 0; k < kBlockVoxels; ++k) {
                const bool known = random() % 4 != 0, coloured = known && random() % 2;
                field.push_back(known ? random() << 16 | (coloured ? random() >> 16 : 0)
                                      : kUnknownField);
                weight.push_back(static_cast<std::uint16_t>(known ? random() % 32768u : 0));
                colour.push_back(coloured ? random() : kNoColour);
            }
        }
        for (int i = 0; i < kWidth * kHeight; ++i) {
            depth_m.push_back(random() % 5 == 0
                                  ? 0.0f
                                  : 0.3f + 1e-7f * static_cast<float>(random() % (1u << 22)));
            packed_colour.push_back(random());
            gone_m.push_back(random() % 2 ? depth_m.back() : 0.0f);
        }
        a.coords = coords.data();
        a.depth_m = depth_m.data();
        a.packed_colour = packed_colour.data();
        a.width = kWidth;
        a.height = kHeight;
        a.fx = a.fy = 90;
        a.cx = 0.5f * kWidth;
        a.cy = 0.5f * kHeight;
        a.frame = 17;
        const float rotation[9] = {0.96f, -0.28f, 0, 0.28f, 0.96f, 0, 0, 0, 1};
        std::copy_n(rotation, 9, a.to_camera.rotation);
        a.to_camera.translation[2] = 0.03f;
        const float twist[6] = {0.5f, -0.4f, 0.3f, 0.2f, -0.3f, 0.1f};
        std::copy_n(twist, 6, a.twist_per_s);
        a.colour_delay_s = 0.01f;
        a.depth_readout_s = a.colour_readout_s = 0.03f;
        a.origin[0] = 3;
        a.voxel_size_m = 0.02f;
        a.band = {0.1f, 0.05f, 0.3f};
        a.epsilon_m = 0.025f;
        a.sigma = 60;
        a.max_weight = 100;
        a.max_colour_weight = 50;
        a.gain = 1.1f;
        a.offset = -0.02f;
        a.frame_weight = 0.9f;
        a.frame_colour_weight = 0.5f;
    }

    FusionArguments Arguments() {
        FusionArguments filled = a;
        if (gone) filled.gone_m = gone_m.data();
        filled.field = field.data();
        filled.weight = weight.data();
        filled.colour = colour.data();
        return filled;
    }
};

void FuseOneByOne(const FusionArguments& a, const std::int32_t* blocks, std::int32_t count) {
    using Kernels = FusionKernels<ScalarLanes>;
    for (std::int32_t b = 0; b < count; ++b)
        for (int i = 0; i < kBlockVoxels; ++i)
            Kernels::FuseVoxels(a, Kernels::RowOf(a, blocks[b], i >> 3 & 7, i >> 6), i & 7);
}

using Fuse = void (*)(const FusionArguments&, const std::int32_t*, std::int32_t);

// Number of voxels that differ after two ways of fusing. `changed` counts the voxels that the first
// one changed.
int Differing(const Scene& scene, Fuse one, Fuse other, int& changed) {
    Scene x = scene, y = scene;
    one(x.Arguments(), x.blocks.data(), kBlocks);
    other(y.Arguments(), y.blocks.data(), kBlocks);
    int differing = 0;
    for (std::size_t i = 0; i < x.field.size(); ++i) {
        changed += x.field[i] != scene.field[i];
        differing +=
            x.field[i] != y.field[i] || x.weight[i] != y.weight[i] || x.colour[i] != y.colour[i];
    }
    return differing;
}

struct Variant {
    bool moving;
    DistanceWeight distance_weight;
    ColourWeighting colour_weighting;
    bool gone;
};

class FusionRows : public ::testing::TestWithParam<Variant> {};

TEST_P(FusionRows, AreTheKernelsOneByOne) {
    Scene scene;
    scene.a.moving = GetParam().moving;
    scene.a.distance_weight = GetParam().distance_weight;
    scene.a.colour_weighting = GetParam().colour_weighting;
    scene.gone = GetParam().gone;
    int changed = 0;
    EXPECT_EQ(Differing(scene, FuseOneByOne, baseline::FuseBlocks, changed), 0);
    ASSERT_GT(changed, kBlocks * kBlockVoxels / 8);
    if (!CpuHasAvx2()) GTEST_SKIP() << "this machine has no AVX2: tested only the portable path";
    EXPECT_EQ(Differing(scene, FuseOneByOne, avx2::FuseBlocks, changed), 0);
}

INSTANTIATE_TEST_SUITE_P(
    Variants, FusionRows,
    ::testing::Values(Variant{false, DistanceWeight::kConstant, ColourWeighting::kSame, false},
                      Variant{false, DistanceWeight::kLinearExp, ColourWeighting::kCosine, true},
                      Variant{true, DistanceWeight::kDepthNoise, ColourWeighting::kCosine, true}));

}  // namespace
}  // namespace tessera
