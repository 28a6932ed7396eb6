#include "finish/texture_view.h"

#include <gtest/gtest.h>

#include <random>

#include "finish/meshes.h"
#include "finish/path_motion.h"
#include "finish/wall_frames.h"

namespace tessera {
namespace {

using Eigen::Vector3f;
using testing_support::Append;
using testing_support::Square;
using testing_support::WallCamera;
using testing_support::WallFrame;
using testing_support::WallPaint;

const Vector3f kOut(0, 0, -1);

TEST(TextureView, ShowsTheColourOfThePlace) {
    const TextureView view = MakeTextureView(WallCamera(), WallFrame({0.1, 0.05, -1}, 0.2), {});
    int seen_points = 0;
    for (float x = -1; x < 1; x += 0.043f)
        for (float y = -1; y < 1; y += 0.037f) {
            const SeenColour seen = See(view, {x, y, 0}, kOut);
            if (seen.weight <= 0) continue;
            ++seen_points;
            EXPECT_LT((seen.rgb - WallPaint(x, y)).abs().maxCoeff(), 2) << x << " " << y;
        }
    EXPECT_GT(seen_points, 200);
}

TEST(TextureView, NotFromBehindNorObliquelyNorOutside) {
    const TextureView view = MakeTextureView(WallCamera(), WallFrame({0, 0, -1}, 0), {});
    EXPECT_GT(See(view, {0, 0, 0}, kOut).weight, 0);
    EXPECT_EQ(See(view, {0, 0, 0}, -kOut).weight, 0);
    EXPECT_EQ(See(view, {0, 0, 0}, Vector3f(1, 0, -0.1f).normalized()).weight, 0);
    EXPECT_EQ(See(view, {2, 0, 0}, kOut).weight, 0);
    EXPECT_EQ(See(view, {0, 0, -2}, kOut).weight, 0);
}

// Whoever walks by has another depth; a surface behind the wall, too.
TEST(TextureView, NotWhatTheDepthContradicts) {
    Frame frame = WallFrame({0, 0, -1}, 0);
    for (int v = 0; v < 120; ++v)
        for (int u = 0; u < 40; ++u) frame.depth_m(u, v) = 0.6f;
    for (int v = 0; v < 120; ++v) frame.depth_m(120, v) = 0;
    const TextureView view = MakeTextureView(WallCamera(), frame, {});
    const auto at = [&](double u) {
        return See(view, WallCamera().Unproject(u, 60, 1).cast<float>() - Vector3f(0, 0, 1), kOut)
            .weight;
    };
    EXPECT_EQ(at(20), 0);
    EXPECT_EQ(at(120), 0);
    EXPECT_GT(at(80), 0);
    EXPECT_EQ(See(view, {0, 0, 0.1f}, kOut).weight, 0);
    EXPECT_GT(See(view, {0, 0, 0.005f}, kOut).weight, 0);  // the map's error
    // Towards the jump and the hole the trust falls.
    EXPECT_LT(at(42), 0.1f * at(80));
    EXPECT_LT(at(118), 0.05f * at(80));
}

TEST(TextureView, NearAndStraightCountsMore) {
    const TextureView near = MakeTextureView(WallCamera(), WallFrame({0, 0, -0.7}, 0), {}),
                      far = MakeTextureView(WallCamera(), WallFrame({0, 0, -1.4}, 0), {}),
                      oblique = MakeTextureView(WallCamera(), WallFrame({-0.7, 0, -0.7}, 0.78), {});
    const float straight = See(near, {0, 0, 0}, kOut).weight;
    EXPECT_NEAR(straight / See(far, {0, 0, 0}, kOut).weight, std::pow(4, 3), 1);
    EXPECT_GT(straight, 8 * See(oblique, {0, 0, 0}, kOut).weight);
}

TEST(TextureView, BlurredAndSaturatedViewsCountLess) {
    TextureView view = MakeTextureView(WallCamera(), WallFrame({0, 0, -1}, 0), {});
    const float sharp = See(view, {0, 0, 0}, kOut).weight;
    view.blur_px = 1;
    EXPECT_NEAR(See(view, {0, 0, 0}, kOut).weight / sharp, 1 / 8.0, 1e-4);
    view.blur_px = 0;
    for (int v = 55; v < 65; ++v)
        for (int u = 75; u < 85; ++u) view.colour(u, v).g = 255;
    EXPECT_NEAR(See(view, {0, 0, 0}, kOut).weight / sharp, 1 / 1000.0, 1e-6);
}

// Each row of each image is rendered where the camera was when it read the row.
TEST(TextureView, AMovingCameraSeesEachRowAtItsTime) {
    const PinholeCamera camera = WallCamera();
    FrameMotion motion{.colour_delay_s = 0.02, .depth_readout_s = 0.02, .colour_readout_s = 0.03};
    motion.twist_per_s << 0.3, 0.8, -0.2, 0.4, -0.1, 0.3;
    const Eigen::Isometry3d T_world_camera = *WallFrame({0, 0, -1}, 0.1).T_world_camera;
    Frame frame = WallFrame({0, 0, -1}, 0.1);
    for (int v = 0; v < camera.height; ++v) {
        const auto place = [&](double time_s, int u, double& depth_m) {
            const Eigen::Isometry3d T = T_world_camera * Se3Exp(time_s * motion.twist_per_s);
            const Eigen::Vector3d ray = T.linear() * camera.Unproject(u, v, 1);
            depth_m = -T.translation().z() / ray.z();
            return Eigen::Vector3d(T.translation() + depth_m * ray);
        };
        for (int u = 0; u < camera.width; ++u) {
            double depth_m = 0, unused = 0;
            place(motion.DepthTime(v, camera.height), u, depth_m);
            frame.depth_m(u, v) = static_cast<float>(depth_m);
            const Eigen::Vector3d seen = place(motion.ColourTime(v, camera.height), u, unused);
            const Eigen::Array3f paint = WallPaint(seen.x(), seen.y());
            frame.colour(u, v) = {static_cast<std::uint8_t>(paint[0] + 0.5f),
                                  static_cast<std::uint8_t>(paint[1] + 0.5f),
                                  static_cast<std::uint8_t>(paint[2] + 0.5f)};
        }
    }
    const TextureView right = MakeTextureView(camera, frame, motion),
                      still = MakeTextureView(camera, frame, {});
    float worst = 0, worst_still = 0;
    int points = 0;
    for (float x = -0.3f; x < 0.35f; x += 0.037f)
        for (float y = -0.2f; y < 0.2f; y += 0.031f) {
            const SeenColour seen = See(right, {x, y, 0}, kOut), off = See(still, {x, y, 0}, kOut);
            ASSERT_GT(seen.weight, 0) << x << " " << y;
            ASSERT_GT(off.weight, 0);
            worst = std::max(worst, (seen.rgb - WallPaint(x, y)).abs().maxCoeff());
            worst_still = std::max(worst_still, (off.rgb - WallPaint(x, y)).abs().maxCoeff());
            ++points;
        }
    EXPECT_GT(points, 200);
    EXPECT_LT(worst, 4);  // to first order
    EXPECT_GT(worst_still, 30);
}

// Half a radian a second, frames a thirtieth apart.
TEST(PathMotion, TheTwistAndTheBlurAreThoseOfTheTurn) {
    std::vector<StampedPose> path;
    for (int i = 0; i < 10; ++i)
        path.push_back({i / 30.0, *WallFrame({0, 0, -1}, 0.5 * i / 30.0).T_world_camera});
    const auto blur_px = [&](double stamp_s) {
        return MotionBlur_px(TwistAt(path, stamp_s), WallCamera());
    };
    Vector6d twist;
    twist << 0, 0.5, 0, 0, 0, 0;
    EXPECT_LT((TwistAt(path, 5 / 30.0) - twist).norm(), 1e-9);
    EXPECT_NEAR(blur_px(5 / 30.0), 0.5 / 60 * 150, 1e-3);
    EXPECT_NEAR(blur_px(5.5 / 30.0), 0.5 / 60 * 150, 1e-3);
    EXPECT_EQ(blur_px(0), 0);
    EXPECT_EQ(blur_px(9 / 30.0), 0);
    path[5].T_world_camera.translation().x() += 3;
    EXPECT_EQ(blur_px(4 / 30.0), 0);  // a jump
    path.erase(path.begin() + 2, path.begin() + 9);
    EXPECT_EQ(blur_px(5 / 30.0), 0);  // a gap
}

TriangleMesh PaintedWall() {
    TriangleMesh wall = Square({-0.5f, -0.4f, 0}, {1, 0, 0}, {0, 1, 0}, 0.9f, 40);
    for (std::size_t i = 0; i < wall.vertices.size(); ++i) {
        const Eigen::Array3f paint = WallPaint(wall.vertices[i].x(), wall.vertices[i].y());
        wall.colours[i] = {static_cast<std::uint8_t>(paint[0]), static_cast<std::uint8_t>(paint[1]),
                           static_cast<std::uint8_t>(paint[2])};
    }
    return wall;
}

TEST(TextureView, TheGainIsThatOfTheModelsColours) {
    const TriangleMesh wall = PaintedWall();
    const Eigen::Array3f exposure(0.8f, 0.7f, 1.1f);
    TextureView view = MakeTextureView(WallCamera(), WallFrame({0, 0, -1}, 0, exposure), {});
    EstimateGain(wall, view);
    EXPECT_LT((view.gain * exposure - 1).abs().maxCoeff(), 0.02f) << view.gain.transpose();
    TextureView elsewhere = MakeTextureView(WallCamera(), WallFrame({5, 0, -1}, 0, exposure), {});
    elsewhere.gain.setConstant(3);
    EstimateGain(wall, elsewhere);
    EXPECT_TRUE((elsewhere.gain == 1).all());
}

// The wall is a 250th of the mesh: of 20000 vertices spread over it, the view shows about 80.
TEST(TextureView, TheGainIsFoundInASmallPartOfALargeMesh) {
    TriangleMesh mesh = PaintedWall();
    Append(mesh, Square({50, 50, 0}, {1, 0, 0}, {0, 1, 0}, 1, 640));
    const Eigen::Array3f exposure(0.8f, 0.7f, 1.1f);
    TextureView view = MakeTextureView(WallCamera(), WallFrame({0, 0, -1}, 0, exposure), {});
    EstimateGain(mesh, view);
    EXPECT_LT((view.gain * exposure - 1).abs().maxCoeff(), 0.03f) << view.gain.transpose();
}

TEST(Sharpness, FallsWithBlur) {
    std::mt19937 random(5);
    ColourImage sharp(60, 40);
    for (std::size_t i = 0; i < sharp.size(); ++i)
        sharp.data()[i].g = static_cast<std::uint8_t>(random() % 256);
    ColourImage blurred = sharp;
    for (int y = 0; y < sharp.height(); ++y)
        for (int x = 1; x + 1 < sharp.width(); ++x)
            blurred(x, y).g = static_cast<std::uint8_t>(
                (sharp(x - 1, y).g + sharp(x, y).g + sharp(x + 1, y).g) / 3);
    EXPECT_LT(Sharpness(blurred), 0.7 * Sharpness(sharp));
    // Steps of 100 of the green, which is 150/256 of the luma, across alone.
    ColourImage stripes(60, 40);
    for (int y = 0; y < 40; ++y)
        for (int x = 0; x < 60; ++x) stripes(x, y).g = x % 2 == 0 ? 0 : 100;
    EXPECT_NEAR(Sharpness(stripes), 100 * 150 / 256.0, 1e-9);
    EXPECT_EQ(Sharpness(ColourImage(30, 20, Rgb8{9, 9, 9})), 0);
    EXPECT_EQ(Sharpness(ColourImage()), 0);
}

}  // namespace
}  // namespace tessera
