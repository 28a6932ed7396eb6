#include "finish/finish.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "finish/decimate.h"
#include "finish/meshes.h"
#include "finish/wall_frames.h"

namespace tessera {
namespace {

using testing_support::Append;
using testing_support::Square;
using testing_support::WallCamera;
using testing_support::WallFrame;
using testing_support::WallPaint;

// The wall, with a crumb in front of it.
TriangleMesh Wall() {
    TriangleMesh mesh = Square({-0.25f, -0.25f, 0}, {1, 0, 0}, {0, 1, 0}, 0.5f, 30);
    for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
        const Eigen::Array3f paint = WallPaint(mesh.vertices[i].x(), mesh.vertices[i].y());
        mesh.colours[i] = {static_cast<std::uint8_t>(paint[0]), static_cast<std::uint8_t>(paint[1]),
                           static_cast<std::uint8_t>(paint[2])};
    }
    Append(mesh, Square({0, 0, -0.3f}, {1, 0, 0}, {0, 1, 0}, 0.02f, 2));
    return mesh;
}

NextPosedFrame Frames(int count) {
    return [count, i = 0](Frame& frame) mutable {
        if (i == count) return false;
        // The exposure changes; every fifth frame has no pose.
        frame = WallFrame({-0.3 + 0.06 * i, 0.02 * i, -0.9}, 0.1 - 0.02 * i,
                          Eigen::Array3f::Constant(1 - 0.04f * static_cast<float>(i)));
        frame.stamp_s = i;
        if (i % 5 == 4) frame.T_world_camera.reset();
        ++i;
        return true;
    };
}

FinishFrames Wanted(int count, NextPosedFrame sample = {}) {
    FinishFrames frames;
    frames.sample = std::move(sample);
    frames.at = [count](const std::vector<double>&) { return Frames(count); };
    frames.count = count;
    return frames;
}

const std::vector<StampedPose>& Path() {
    static const std::vector<StampedPose> path = [] {
        std::vector<StampedPose> poses;
        Frame frame;
        for (NextPosedFrame next = Frames(10); next(frame);)
            if (frame.T_world_camera) poses.push_back({frame.stamp_s, *frame.T_world_camera});
        return poses;
    }();
    return path;
}

Eigen::Array3f ColourAt(const TexturedMesh& model, std::size_t vertex) {
    const Eigen::Vector2f at = model.uv[vertex];
    const Rgb8 c =
        model.texture(static_cast<int>(at.x() * static_cast<float>(model.texture.width())),
                      static_cast<int>(at.y() * static_cast<float>(model.texture.height())));
    return {static_cast<float>(c.r), static_cast<float>(c.g), static_cast<float>(c.b)};
}

TEST(Finish, AWallIsCleanedThinnedAndPainted) {
    std::vector<double> shares;
    const Result<FinishedModel> finished =
        FinishModel(Wall(), WallCamera(), Path(), Wanted(10), {}, [&](const char*, double share) {
            shares.push_back(share);
            return true;
        });
    ASSERT_TRUE(finished.ok()) << finished.message();
    const FinishReport& report = finished.value().report;
    const TexturedMesh& model = finished.value().model;
    EXPECT_EQ(report.triangles_before, 1808u);
    EXPECT_EQ(report.islands.islands, 1u);
    EXPECT_EQ(report.model().charts, 1u);
    EXPECT_EQ(report.frames, 8);  // two have no pose
    EXPECT_GT(report.views, 2);
    EXPECT_LE(report.views, 8);
    EXPECT_GT(report.model().seen_share, 0.95);
    if (DecimationAvailable()) {
        EXPECT_LE(model.mesh.triangles.size(), 190u);
    }
    ASSERT_EQ(model.uv.size(), model.mesh.vertices.size());
    for (std::size_t i = 0; i < model.uv.size(); ++i) {
        const Eigen::Vector3f& p = model.mesh.vertices[i];
        EXPECT_EQ(p.z(), 0);
        // A texel is 6 mm here, as the pixels are: six levels of the paint.
        EXPECT_LT((ColourAt(model, i) - WallPaint(p.x(), p.y())).abs().maxCoeff(), 12)
            << p.transpose();
    }
    EXPECT_TRUE(std::ranges::is_sorted(shares));
    EXPECT_EQ(shares.back(), 1);
}

// A hole of 6 cm, a board that was carried off before the other frames, and lower levels.
TEST(Finish, HolesAreClosedFlapsGoAndLowerLevelsAreLighter) {
    TriangleMesh mesh = Wall();
    std::erase_if(mesh.triangles, [&](const auto& t) {
        return (mesh.vertices[t[0]] + mesh.vertices[t[1]] + mesh.vertices[t[2]]).norm() < 0.09f;
    });
    Append(mesh, Square({-0.1f, -0.1f, -0.2f}, {1, 0, 0}, {0, 1, 0}, 0.15f, 10));
    FinishOptions options;
    options.lower_levels = 2;
    options.clean.decimation_share = 1;
    const auto finish = [&] {
        auto finished = FinishModel(mesh, WallCamera(), Path(), Wanted(10, Frames(10)), options,
                                    [](const char*, double) { return true; });
        EXPECT_TRUE(finished.ok()) << finished.message();
        return std::move(finished.value());
    };
    const FinishedModel finished = finish();
    const FinishReport& report = finished.report;
    EXPECT_EQ(report.evidence_frames, 8u);
    EXPECT_GE(report.flaps.triangles, 200u);  // the board, and the crumb
    EXPECT_EQ(report.holes.closed, 1u);
    EXPECT_NEAR(report.holes.area_m2, 3.14 * 0.03 * 0.03, 8e-4);
    EXPECT_FALSE(finished.filled.triangles.empty());
    for (const Eigen::Vector3f& v : finished.model.mesh.vertices) EXPECT_NEAR(v.z(), 0, 1e-5);
    EXPECT_GT(report.model().seen_share, 0.95);
    ASSERT_EQ(report.levels.size(), 3u);
    ASSERT_EQ(finished.lower_levels.size(), 2u);
    for (std::size_t i = 0; DecimationAvailable() && i < 2; ++i) {
        const TexturedMesh& level = finished.lower_levels[i];
        const LevelReport &lower = report.levels[i + 1], &above = report.levels[i];
        EXPECT_EQ(level.mesh.triangles.size(), lower.triangles);
        EXPECT_LE(lower.triangles, above.triangles / 4 + 1);
        EXPECT_GE(lower.texel_m, 1.9 * above.texel_m);
        EXPECT_GE(lower.error_m, above.error_m);
        EXPECT_GT(lower.seen_share, 0.95);
        std::size_t wrong = 0;  // corners of slivers without texels
        for (std::size_t v = 0; v < level.uv.size(); ++v) {
            const Eigen::Vector3f& p = level.mesh.vertices[v];
            wrong += (ColourAt(level, v) - WallPaint(p.x(), p.y())).abs().maxCoeff() > 40;
        }
        EXPECT_LE(wrong, level.uv.size() / 20);
    }
    options.clean.hole_m = 0;
    options.clean.remove_flaps = false;
    const FinishedModel kept = finish();
    EXPECT_EQ(kept.report.holes.closed, 0u);
    EXPECT_EQ(kept.report.flaps.triangles, 0u);
    EXPECT_TRUE(kept.filled.triangles.empty());
}

// The wall's 4 m take 400 texels of a centimetre; the texture has 256.
TEST(Finish, ALowerLevelsTexelsAreTwiceAsWideAsThoseReached) {
    FinishOptions options;
    options.lower_levels = 1;
    options.clean.decimation_share = 1;
    options.texture = {.texel_m = 0.01, .texture_side = 256};
    const auto finished =
        FinishModel(Square({-2, -2, 0}, {1, 0, 0}, {0, 1, 0}, 4, 60), WallCamera(), Path(),
                    Wanted(1), options, [](const char*, double) { return true; });
    ASSERT_TRUE(finished.ok()) << finished.message();
    const std::vector<LevelReport>& levels = finished.value().report.levels;
    ASSERT_EQ(levels.size(), 2u);
    EXPECT_GT(levels[0].texel_m, 0.012);
    EXPECT_DOUBLE_EQ(levels[1].texel_m, 2 * levels[0].texel_m);
}

// A quarter of eight triangles is no surface worth a file.
TEST(Finish, LevelsEndWhereNothingIsLeft) {
    FinishOptions options;
    options.lower_levels = 6;
    options.clean.decimation_share = 1;
    options.clean.remove_flaps = false;
    const auto finished =
        FinishModel(Square({-0.2f, -0.2f, 0}, {1, 0, 0}, {0, 1, 0}, 0.4f, 2), WallCamera(), Path(),
                    Wanted(1), options, [](const char*, double) { return true; });
    ASSERT_TRUE(finished.ok()) << finished.message();
    EXPECT_EQ(finished.value().model.mesh.triangles.size(), 8u);
    const std::vector<TexturedMesh>& lower = finished.value().lower_levels;
    EXPECT_EQ(finished.value().report.levels.size(), 1 + lower.size());
    for (const TexturedMesh& level : lower) EXPECT_GE(level.mesh.triangles.size(), 4u);
}

TEST(Finish, CanBeCancelledAtEachStep) {
    for (int at = 0; at < 6; ++at) {
        int steps = 0;
        const Result<FinishedModel> finished =
            FinishModel(Wall(), WallCamera(), Path(), Wanted(10), {},
                        [&](const char*, double) { return steps++ < at; });
        ASSERT_FALSE(finished.ok());
        EXPECT_EQ(finished.message(), "cancelled");
        EXPECT_EQ(steps, at + 1);
    }
}

TEST(Finish, AMeshWithoutColoursIsPaintedAndAnEmptyOneIsAnError) {
    TriangleMesh mesh = Wall();
    mesh.colours.clear();
    const auto go_on = [](const char*, double) { return true; };
    const Result<FinishedModel> finished =
        FinishModel(mesh, WallCamera(), Path(), Wanted(1), {}, go_on);
    ASSERT_TRUE(finished.ok());
    EXPECT_GT(finished.value().report.model().seen_share, 0.5);
    EXPECT_FALSE(FinishModel({}, WallCamera(), Path(), Wanted(1), {}, go_on).ok());
    mesh.normals.clear();
    const auto without = FinishModel(mesh, WallCamera(), Path(), Wanted(1), {}, go_on);
    EXPECT_NE(without.message().find("has no normals"), std::string::npos);
}

}  // namespace
}  // namespace tessera
