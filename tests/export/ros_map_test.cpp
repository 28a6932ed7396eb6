#include "export/ros_map.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "core/input_file.h"
#include "support/temp_folder.h"

namespace tessera {
namespace {

// 4 x 3 columns of 0.25 m from -0.25 m below the floor to 2.25 m, lower left corner at (-0.5,
// 0.25).
Occupancy Nothing() {
    const Eigen::AlignedBox3d box(Eigen::Vector3d(-0.5, 0.25, -0.25),
                                  Eigen::Vector3d(0.5, 1, 2.25));
    const CellGrid grid = MakeGrid(box, 0.25, Eigen::Isometry3d::Identity()).value();
    return {grid, std::vector<CellState>(grid.cells(), CellState::kUnknown)};
}

class RosMaps : public ::testing::Test {
  protected:
    // The cell at this height.
    void Set(int x, int y, double height_m, CellState state) {
        const int z = static_cast<int>(std::floor(height_m / 0.25)) + 1;
        occupancy.cells[occupancy.grid.Index(x, y, z)] = state;
    }
    // By x and y from the lower left.
    int Pixel(int x, int y) const {
        return MakeRosMap(occupancy, heights).pixels(x, occupancy.grid.size.y() - 1 - y);
    }

    Occupancy occupancy = Nothing();
    RosMap::Options heights;
};

TEST_F(RosMaps, TheFirstRowHasTheLargestYAndTheOriginIsTheLowerLeftCorner) {
    Set(3, 0, 1, CellState::kOccupied);
    Set(0, 2, 1, CellState::kFree);
    const RosMap map = MakeRosMap(occupancy, heights);
    ASSERT_EQ(map.pixels.width(), 4);
    ASSERT_EQ(map.pixels.height(), 3);
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 4; ++column) {
            int expected = RosMap::kUnknown;
            if (row == 2 && column == 3) expected = RosMap::kOccupied;
            if (row == 0 && column == 0) expected = RosMap::kFree;
            EXPECT_EQ(map.pixels(column, row), expected) << column << ", " << row;
        }
    EXPECT_DOUBLE_EQ(map.origin_x_m, -0.5);
    EXPECT_DOUBLE_EQ(map.origin_y_m, 0.25);
}

TEST_F(RosMaps, ObstaclesCountBetweenTheHeights) {
    EXPECT_EQ(Pixel(0, 0), RosMap::kUnknown);
    Set(0, 0, 1, CellState::kFree);
    EXPECT_EQ(Pixel(0, 0), RosMap::kFree);
    Set(0, 0, 1.55, CellState::kOccupied);  // centre at 1.625
    EXPECT_EQ(Pixel(0, 0), RosMap::kOccupied);
    heights.high_m = 1.6;
    EXPECT_EQ(Pixel(0, 0), RosMap::kFree);
    heights = {.low_m = 1.7, .high_m = 2};
    EXPECT_EQ(Pixel(0, 0), RosMap::kFree);
}

TEST_F(RosMaps, TheFloorAloneIsFreeAndTheCeilingAloneIsUnknown) {
    Set(0, 0, -0.01, CellState::kOccupied);  // centre at -0.125
    Set(1, 0, 2.1, CellState::kOccupied);
    Set(2, 0, 2.1, CellState::kFree);
    Set(3, 0, 0.01, CellState::kOccupied);  // centre at 0.125
    heights.low_m = 0.2;
    EXPECT_EQ(Pixel(0, 0), RosMap::kFree);
    EXPECT_EQ(Pixel(1, 0), RosMap::kUnknown);
    EXPECT_EQ(Pixel(2, 0), RosMap::kUnknown);
    EXPECT_EQ(Pixel(3, 0), RosMap::kFree);
    // The cell begins below 0.1 m, as that of a bare floor does.
    heights.low_m = 0.1;
    EXPECT_EQ(Pixel(0, 0), RosMap::kFree);
    EXPECT_EQ(Pixel(3, 0), RosMap::kFree);
    heights.low_m = 0;
    EXPECT_EQ(Pixel(0, 0), RosMap::kUnknown);  // too far below to be the floor
    EXPECT_EQ(Pixel(3, 0), RosMap::kOccupied);
}

// At 0.05 m the obstacles begin with the third cell above the floor, which begins at 0.1 m.
TEST_F(RosMaps, CellsCountFromTheirLowerSide) {
    const Eigen::AlignedBox3d box(Eigen::Vector3d(0, 0, -0.25), Eigen::Vector3d(0.05, 0.05, 2));
    const CellGrid grid = MakeGrid(box, 0.05, Eigen::Isometry3d::Identity()).value();
    for (int z = 0; z < grid.size.z(); ++z) {
        occupancy = {grid, std::vector<CellState>(grid.cells(), CellState::kUnknown)};
        occupancy.cells[grid.Index(0, 0, z)] = CellState::kOccupied;
        const int above = z - 5;  // the floor
        const int expected = above < -2 || above >= 36 ? RosMap::kUnknown
                             : above < 2               ? RosMap::kFree
                                                       : RosMap::kOccupied;
        EXPECT_EQ(Pixel(0, 0), expected) << above;
    }
}

TEST_F(RosMaps, TheFilesAreAsMapServerReadsThem) {
    Set(3, 0, 1, CellState::kOccupied);
    Set(0, 2, 1, CellState::kFree);
    const TempFolder folder;
    ASSERT_TRUE(WriteRosMap(folder / "a.yaml", MakeRosMap(occupancy, heights)).ok());
    const char u = '\xcd', f = '\xfe', o = '\0';
    const std::string pixels = {f, u, u, u, u, u, u, u, u, u, u, o};
    EXPECT_EQ(ReadWholeFile(folder / "a.pgm", 1 << 20).value(), "P5\n4 3\n255\n" + pixels);
    EXPECT_EQ(ReadWholeFile(folder / "a.yaml", 1 << 20).value(),
              "image: a.pgm\nmode: trinary\nresolution: 0.25\norigin: [-0.5, 0.25, 0]\n"
              "negate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n");
    // nav2: the probability of an obstacle is (255 - value) / 255.
    const auto probability = [](int value) { return (255 - value) / 255.0; };
    EXPECT_GT(probability(RosMap::kOccupied), 0.65);
    EXPECT_LT(probability(RosMap::kFree), 0.196);
    EXPECT_GT(probability(RosMap::kUnknown), 0.196);
    EXPECT_LT(probability(RosMap::kUnknown), 0.65);
}

TEST_F(RosMaps, AnErrorNamesTheFile) {
    const TempFolder folder;
    EXPECT_NE(WriteRosMap(folder / "none/a.yaml", MakeRosMap(occupancy, heights))
                  .message()
                  .find("none/a.pgm"),
              std::string::npos);
    std::filesystem::create_directory(folder / "b.yaml");
    EXPECT_NE(
        WriteRosMap(folder / "b.yaml", MakeRosMap(occupancy, heights)).message().find("b.yaml"),
        std::string::npos);
}

}  // namespace
}  // namespace tessera
