#include "finish/patch.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "finish/wall_frames.h"

namespace tessera {
namespace {

using testing_support::WallCamera;
using testing_support::WallFrame;

struct Point {
    Eigen::Vector3f point, normal;
};

// Random patches on and beside the wall, against each of their points.
TEST(Patch, LeavesOutOnlyWhatTheViewDoesNotShow) {
    FrameMotion motion{.colour_delay_s = 0.01, .depth_readout_s = 0.03, .colour_readout_s = 0.03};
    motion.twist_per_s << 0.5, 1, 0.3, 0.5, 0.2, 0.8;
    const TextureView view = MakeTextureView(WallCamera(), WallFrame({0, 0, -1}, 0.3), motion);
    std::mt19937 random(3);
    std::uniform_real_distribution<float> uniform(-1, 1);
    const auto vector = [&] {
        return Eigen::Vector3f(uniform(random), uniform(random), uniform(random));
    };
    int left_out = 0, shown = 0;
    for (int i = 0; i < 20000; ++i) {
        const Eigen::Vector3f reach =
            i % 2 == 0 ? Eigen::Vector3f(0.7f, 0.5f, 0.02f) : Eigen::Vector3f(2, 1.5f, 0.5f);
        const Eigen::Vector3f centre = vector().cwiseProduct(reach);
        const Eigen::Vector3f axis = vector();
        const float size_m = 0.2f * std::abs(uniform(random)), bent = std::abs(uniform(random));
        std::vector<Point> points;
        for (int k = 0; k < 20; ++k)
            points.push_back({centre + size_m * vector(), (axis + bent * vector()).normalized()});
        bool seen = false;
        for (const Point& p : points) seen |= See(view, p.point, p.normal).weight > 0;
        const bool may = MayShow(view, PatchOf(points));
        EXPECT_TRUE(may || !seen) << i;
        left_out += !may;
        shown += seen;
    }
    EXPECT_GT(left_out, 8000);
    EXPECT_GT(shown, 1000);
}

TEST(Patch, BehindWhatTheViewMeasuredNothingIsShown) {
    const TextureView view = MakeTextureView(WallCamera(), WallFrame({0, 0, -1}, 0), {});
    const auto at = [](float z) {
        return PatchOf(std::vector<Point>{{{0, 0, z}, {0, 0, -1}}, {{0.1f, 0, z}, {0, 0, -1}}});
    };
    EXPECT_TRUE(MayShow(view, at(0)));
    EXPECT_FALSE(MayShow(view, at(1)));
    EXPECT_FALSE(MayShow(view, at(-1.2f)));
    EXPECT_TRUE(MayShow(
        view, PatchOf(std::vector<Point>{{{0, 0, 0}, {0, 0, -1}}, {{0, 0, 3}, {0, 0, -1}}})));
}

// The same normal is turned away from one end's ray and not from the other's.
TEST(Patch, OfALargeOneOneEndMayBeSeen) {
    const TextureView view = MakeTextureView(WallCamera(), WallFrame({0, 0, -1}, 0), {});
    const Eigen::Vector3f normal = Eigen::Vector3f(1, 0, 0.2f).normalized();
    const std::vector<Point> points{{{-0.5f, 0, 0}, normal}, {{0.5f, 0, 0}, normal}};
    EXPECT_GT(See(view, points[0].point, normal).weight, 0);
    EXPECT_EQ(See(view, points[1].point, normal).weight, 0);
    EXPECT_TRUE(MayShow(view, PatchOf(points)));
}

}  // namespace
}  // namespace tessera
