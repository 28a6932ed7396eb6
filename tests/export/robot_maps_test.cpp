#include "export/robot_maps.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <functional>

#include "core/input_file.h"
#include "mapping/analytic_fields.h"
#include "support/box_room.h"
#include "support/temp_folder.h"

namespace tessera {
namespace {

using testing_support::SmallCamera;

class RobotMapFiles : public ::testing::Test {
  protected:
    RobotMapFiles() {
        testing_support::Fill(map,
                              [this](const Eigen::Vector3d& p) { return room.SignedDistance(p); },
                              {-6, -4, -5}, {5, 4, 8});
        // The room's floor is at y = high.y(), y down.
        T_level_world.linear() << 1, 0, 0, 0, 0, 1, 0, -1, 0;
        T_level_world.translation() << 0, 0, room.high.y();
        for (int i = 0; i < 5; ++i) path.push_back({0.1 * i, testing_support::SmoothPath(20 * i)});
    }
    std::string Write(const RobotMaps& maps) const {
        return WriteRobotMaps(maps, map, SmallCamera(), path, T_level_world, "level").message();
    }

    testing_support::BoxRoom room;
    BlockMap map{BlockMap::Config{.voxel_size_m = 0.04, .truncation_m = 0.12}};
    Eigen::Isometry3d T_level_world = Eigen::Isometry3d::Identity();
    std::vector<StampedPose> path;
    TempFolder folder;
};

TEST_F(RobotMapFiles, AllOutputsComeFromOneGridAroundTheMap) {
    RobotMaps maps;
    maps.ros_map = folder / "a.yaml";
    maps.octomap = folder / "a.bt";
    maps.distance = folder / "d.npy";
    maps.resolution_m = 0.1;
    maps.heights.high_m = 1.5;  // the ceiling is at 1.7 m
    ASSERT_EQ(Write(maps), "");
    for (const char* name : {"a.yaml", "a.pgm", "a.bt", "d.npy", "d_known.npy", "d.yaml"})
        EXPECT_TRUE(std::filesystem::exists(folder / name)) << name;
    // The walls are at x = -1.3 and 1.1, and along the level y at -1 and 1.9.
    const std::string pgm = ReadWholeFile(folder / "a.pgm", 1 << 20).value();
    const std::string yaml = ReadWholeFile(folder / "a.yaml", 1 << 20).value();
    int width = 0, height = 0;
    double origin_x = 0, origin_y = 0;
    ASSERT_EQ(sscanf(pgm.c_str(), "P5 %d %d 255", &width, &height), 2);
    ASSERT_EQ(sscanf(yaml.c_str() + yaml.find("origin"), "origin: [%lf, %lf", &origin_x, &origin_y),
              2);
    const std::string pixels = pgm.substr(pgm.size() - static_cast<std::size_t>(width * height));
    const auto at = [&](double x_m, double y_m) {
        const int x = static_cast<int>((x_m - origin_x) / 0.1),
                  y = static_cast<int>((y_m - origin_y) / 0.1);
        return static_cast<unsigned char>(
            pixels[static_cast<std::size_t>(x + width * (height - 1 - y))]);
    };
    EXPECT_EQ(at(0.05, 1.05), RosMap::kFree);
    EXPECT_EQ(at(1.1, 1.05), RosMap::kOccupied);
    EXPECT_EQ(at(0.05, 1.9), RosMap::kOccupied);
    EXPECT_EQ(at(0.05, 2.25), RosMap::kUnknown);
    EXPECT_EQ(at(-1.65, 1.05), RosMap::kUnknown);
}

TEST_F(RobotMapFiles, ABoxLimitsTheMaps) {
    RobotMaps maps;
    maps.ros_map = folder / "a.yaml";
    maps.box_m = Eigen::AlignedBox3d(Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(0.5, 1, 1.5));
    ASSERT_EQ(Write(maps), "");
    EXPECT_EQ(ReadWholeFile(folder / "a.pgm", 1 << 20).value().substr(0, 9), "P5\n10 20\n");
    EXPECT_FALSE(std::filesystem::exists(folder / "a.bt"));
}

TEST_F(RobotMapFiles, NoFileIsWrittenTwice) {
    const auto check = [](const std::string& ros_map, const std::string& distance) {
        RobotMaps maps;
        maps.ros_map = ros_map;
        maps.distance = distance;
        return CheckRobotMaps(maps).message();
    };
    EXPECT_EQ(
        check("a/room.yaml", "a/room.npy"),
        "--ros-map a/room.yaml and --distance a/room.npy: both write a/room.yaml; give one of "
        "them another name");
    EXPECT_NE(check("./room.yaml", "a/../room.npy"), "");
    EXPECT_NE(check(std::filesystem::absolute("room.yaml").string(), "room.npy"), "");
    EXPECT_EQ(check("room.yaml", "a/room.npy"), "");
    EXPECT_EQ(check("room.yaml", "room_esdf.npy"), "");
}

TEST_F(RobotMapFiles, ErrorsNameTheOption) {
    const auto expect = [&](const std::function<void(RobotMaps&)>& change, const char* text) {
        RobotMaps maps;
        maps.octomap = folder / "a.bt";
        change(maps);
        EXPECT_NE(CheckRobotMaps(maps).message().find(text), std::string::npos)
            << CheckRobotMaps(maps).message();
        EXPECT_NE(Write(maps), "");
    };
    const Eigen::Vector3d one = Eigen::Vector3d::Ones();
    expect([](RobotMaps& m) { m.ros_map = "a.pgm"; },
           "--ros-map a.pgm: a ROS map is written as .yaml");
    expect([](RobotMaps& m) { m.octomap = "a.ot"; }, "--octomap a.ot: ");
    expect([](RobotMaps& m) { m.distance = "a.npz"; }, "--distance a.npz: ");
    expect([](RobotMaps& m) { m.resolution_m = 0; }, "--resolution: a resolution of 0 m");
    expect([](RobotMaps& m) { m.heights.high_m = 0.1; }, "--heights 0.1 0.1: ");
    expect([](RobotMaps& m) { m.heights.low_m = -0.1; },
           "--heights -0.1 1.8: the first is a height above the floor and must not be negative");
    expect([&](RobotMaps& m) { m.box_m = Eigen::AlignedBox3d(0 * one, 1e4 * one); },
           "--box, --resolution: 200000 x 200000 x 200000 cells");
    RobotMaps maps;
    maps.octomap = folder / "a.bt";
    maps.box_m = Eigen::AlignedBox3d(0 * one, one);
    maps.resolution_m = 0.005;
    EXPECT_EQ(Write(maps),
              "--box, --resolution: a resolution of 0.005 m is finer than a quarter of the map's "
              "voxels; take at least 0.01 m");
    maps.box_m.reset();
    maps.resolution_m = 0.05;
    map.Clear();
    EXPECT_NE(Write(maps).find("map is empty"), std::string::npos);
}

}  // namespace
}  // namespace tessera
