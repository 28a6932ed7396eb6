#include "plan/floor_plan.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>

#include "box_world.h"

namespace tessera {
namespace {

FloorPlan PlanOf(const TriangleMesh& mesh, const std::vector<StampedPose>& path,
                 double noise_m = 0) {
    FloorPlanOptions options;
    options.noise_m = noise_m;
    Result<FloorPlan> plan = MakeFloorPlan(mesh, path, options);
    EXPECT_TRUE(plan.ok()) << plan.message();
    return plan.ok() ? plan.value() : FloorPlan{};
}

// The rooms of TwoRooms, moved by T, to a centimetre and a third of a per cent.
void ExpectTwoRooms(const FloorPlan& plan,
                    const Eigen::Isometry3d& T = Eigen::Isometry3d::Identity()) {
    ASSERT_EQ(plan.rooms.size(), 2U);
    EXPECT_NEAR(plan.rooms[0].area_m2, 12, 0.04);
    EXPECT_NEAR(plan.rooms[0].perimeter_m, 14, 0.03);
    EXPECT_NEAR(plan.rooms[1].area_m2, 9, 0.03);
    EXPECT_EQ(plan.rooms[0].outline.size(), 4U);
    ASSERT_EQ(plan.openings.size(), 1U);
    EXPECT_NEAR(plan.openings[0].Width(), 0.9, 0.01);
    for (const double y : {1.0, 1.9}) {
        const Eigen::Vector2d side =
            (plan.T_plan_world * T * Eigen::Vector3d(4.06, y, 0)).head<2>();
        EXPECT_LT(
            std::min((side - plan.openings[0].begin).norm(), (side - plan.openings[0].end).norm()),
            0.01);
    }
    ASSERT_TRUE(plan.openings[0].thickness_m && plan.openings[0].height_m);
    EXPECT_NEAR(*plan.openings[0].thickness_m, 0.12, 0.003);
    EXPECT_NEAR(*plan.openings[0].height_m, 2.0, 0.06);
    ASSERT_TRUE(plan.ceiling_m);
    EXPECT_NEAR(*plan.ceiling_m, kBoxHeight, 0.005);
    double divided = 0;
    for (const PlanWall& wall : plan.walls)
        if (wall.thickness_m && std::abs(*wall.thickness_m - 0.12) < 0.003)
            divided += wall.Length();
    EXPECT_NEAR(divided, 2.1, 0.02);
    for (const PlanWall& wall : plan.walls) EXPECT_TRUE(wall.seen);
}

TEST(FloorPlan, MeasuresTwoRoomsAndTheDoorBetweenThem) {
    ExpectTwoRooms(PlanOf(TwoRooms(), UprightPath()));
}

TEST(FloorPlan, HoldsForARoomTurnedAndTilted) {
    TriangleMesh mesh = TwoRooms();
    std::vector<StampedPose> path = UprightPath(1.1);
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    T.linear() = (Eigen::AngleAxisd(30 * std::numbers::pi / 180, Eigen::Vector3d::UnitZ()) *
                  Eigen::AngleAxisd(0.1, Eigen::Vector3d::UnitX()))
                     .toRotationMatrix();
    T.translation() = Eigen::Vector3d(3, -2, 1);
    Move(T, mesh, path);
    const FloorPlan plan = PlanOf(mesh, path);
    ExpectTwoRooms(plan, T);
    // In the plan, walls run along the axes; the transform takes the world there.
    for (const PlanWall& wall : plan.walls)
        EXPECT_LT(std::min(std::abs(wall.normal.x()), std::abs(wall.normal.y())), 0.002);
    const Eigen::Vector3d corner = plan.T_plan_world * T * Eigen::Vector3d(4, 3, 0);
    EXPECT_NEAR(corner.z(), 0, 0.003);
    EXPECT_TRUE(std::ranges::any_of(plan.rooms[0].outline, [&](const Eigen::Vector2d& p) {
        return (p - corner.head<2>()).norm() < 0.01;
    }));
}

TEST(FloorPlan, DoesNotDependOnItsOneConstant) {
    for (const double noise_m : {0.005 / 1.5, 0.005, 0.005 * 1.5})
        ExpectTwoRooms(PlanOf(TwoRooms(), UprightPath(), noise_m));
}

TEST(FloorPlan, FollowsAnLShapedRoom) {
    const FloorPlan plan = PlanOf(LRoom(), UprightPath());
    ASSERT_EQ(plan.rooms.size(), 1U);
    EXPECT_NEAR(plan.rooms[0].area_m2, 16 - 2.5 * 2, 0.04);
    EXPECT_NEAR(plan.rooms[0].perimeter_m, 16, 0.04);
    EXPECT_EQ(plan.rooms[0].outline.size(), 6U);
    EXPECT_TRUE(plan.openings.empty());
}

TEST(FloorPlan, KeepsWallsThatAreNotSquare) {
    TriangleMesh mesh;
    AddFloorAndCeiling(-0.2, -0.2, 5.2, 4.2, mesh);
    AddWall(-0.2, -0.2, 0, 4.2, mesh);
    AddWall(0, -0.2, 5.2, 0, mesh);
    AddWall(0, 4, 5.2, 4.2, mesh);
    // From (5, 0) to (3, 4): 26.57 degrees off.
    TriangleMesh slanted;
    AddWall(0, 0, 0.2, std::sqrt(20.0), slanted);
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    T.linear() = Eigen::AngleAxisd(std::atan2(2, 4), Eigen::Vector3d::UnitZ()).toRotationMatrix();
    T.translation() = Eigen::Vector3d(5, 0, 0);
    std::vector<StampedPose> none;
    Move(T, slanted, none);
    const auto base = static_cast<std::uint32_t>(mesh.vertices.size());
    mesh.vertices.insert(mesh.vertices.end(), slanted.vertices.begin(), slanted.vertices.end());
    for (const auto& t : slanted.triangles)
        mesh.triangles.push_back({base + t[0], base + t[1], base + t[2]});
    const FloorPlan plan = PlanOf(mesh, UprightPath());
    ASSERT_EQ(plan.rooms.size(), 1U);
    EXPECT_NEAR(plan.rooms[0].area_m2, 16, 0.05);
    EXPECT_EQ(plan.rooms[0].outline.size(), 4U);
}

TEST(FloorPlan, SaysThatAnOpenPlaceHasNoRoom) {
    TriangleMesh mesh;
    AddBox({0, 0, -0.1}, {4, 4, 0}, mesh);
    AddWall(0, 4, 4, 4.2, mesh);
    const FloorPlan plan = PlanOf(mesh, UprightPath());
    EXPECT_TRUE(plan.rooms.empty());
    EXPECT_NEAR(plan.floor_m2, 16, 0.5);
    ASSERT_FALSE(plan.walls.empty());
    EXPECT_NEAR(plan.walls[0].Length(), 4, 0.02);
    ASSERT_TRUE(plan.walls[0].thickness_m);  // both faces are there
    EXPECT_NEAR(*plan.walls[0].thickness_m, 0.2, 0.003);
}

TEST(FloorPlan, RefusesWhatIsNoBuilding) {
    const auto message = [](const TriangleMesh& mesh) {
        return MakeFloorPlan(mesh, UprightPath(), {}).message();
    };
    EXPECT_NE(message({}).find("empty"), std::string::npos);
    TriangleMesh millimetres = TwoRooms();
    for (Eigen::Vector3f& vertex : millimetres.vertices) vertex *= 1000;
    EXPECT_NE(message(millimetres), "");
    TriangleMesh huge = TwoRooms();
    for (Eigen::Vector3f& vertex : huge.vertices) vertex *= 1e8F;
    EXPECT_NE(message(huge), "");
    TriangleMesh wall;
    AddWall(0, 0, 4, 0.2, wall);
    wall.triangles.erase(wall.triangles.begin(), wall.triangles.begin() + 4);  // top and bottom
    EXPECT_NE(message(wall).find("horizontal"), std::string::npos);
}

TEST(FloorPlan, LeavesOutWhatIsNotFiniteOrFarAway) {
    TriangleMesh mesh = TwoRooms();
    const auto base = static_cast<std::uint32_t>(mesh.vertices.size());
    mesh.vertices.emplace_back(std::numeric_limits<float>::quiet_NaN(), 0.F, 0.F);
    mesh.vertices.emplace_back(1e9F, 1e9F, 1e9F);
    mesh.vertices.emplace_back(0.F, std::numeric_limits<float>::infinity(), 0.F);
    mesh.triangles.push_back({base, 0, 1});
    mesh.triangles.push_back({base + 1, 0, 1});
    mesh.triangles.push_back({base + 2, 2, 3});
    mesh.triangles.push_back({4'000'000'000U, 0, 1});
    const FloorPlan plan = PlanOf(mesh, UprightPath());
    EXPECT_EQ(plan.skipped_triangles, 4U);
    ExpectTwoRooms(plan);
}

// Time and memory stay bounded, whatever floats about.
TEST(FloorPlan, BearsManyIslands) {
    TriangleMesh mesh = TwoRooms();
    std::mt19937 random(3);
    std::uniform_real_distribution<float> anywhere(-200, 200), near(-0.2F, 0.2F);
    for (int i = 0; i < 200'000; ++i) {
        const auto base = static_cast<std::uint32_t>(mesh.vertices.size());
        const Eigen::Vector3f at(anywhere(random), anywhere(random), 0.02F * anywhere(random));
        for (int k = 0; k < 3; ++k)
            mesh.vertices.emplace_back(at +
                                       Eigen::Vector3f(near(random), near(random), near(random)));
        mesh.triangles.push_back({base, base + 1, base + 2});
    }
    // The rooms are lost among 6000 m2 of debris or found; neither may take for ever.
    const Result<FloorPlan> plan = MakeFloorPlan(mesh, UprightPath(), {});
    if (plan.ok()) {
        EXPECT_LT(plan.value().walls.size(), 1000U);
    }
}

}  // namespace
}  // namespace tessera
