#include "export/cell_grid.h"

#include <gtest/gtest.h>

#include <cmath>

#include "mapping/analytic_fields.h"

namespace tessera {
namespace {

using Box = Eigen::AlignedBox3d;
const Eigen::Isometry3d kWorld = Eigen::Isometry3d::Identity();

TEST(CellGrid, TheBoxGrowsToWholeCellsOfTheFrame) {
    const Result<CellGrid> made = MakeGrid(
        Box(Eigen::Vector3d(-0.12, 0.1, 0.26), Eigen::Vector3d(0.2, 0.3, 0.27)), 0.1, kWorld);
    ASSERT_TRUE(made.ok()) << made.message();
    const CellGrid& grid = made.value();
    EXPECT_EQ(grid.first, Eigen::Vector3i(-2, 1, 2));
    EXPECT_EQ(grid.size, Eigen::Vector3i(4, 2, 1));  // 0.3 / 0.1 is a little less than 3
    EXPECT_TRUE(grid.Low().isApprox(Eigen::Vector3d(-0.2, 0.1, 0.2)));
    EXPECT_TRUE(grid.Centre(3, 0, 0).isApprox(Eigen::Vector3d(0.15, 0.15, 0.25)));
    EXPECT_EQ(grid.cells(), 8u);
    EXPECT_EQ(grid.Index(3, 1, 0), 7u);
    const CellGrid padded = Padded(grid, 3).value();
    EXPECT_EQ(padded.first, Eigen::Vector3i(-5, -2, -1));
    EXPECT_EQ(padded.size, Eigen::Vector3i(10, 8, 7));
}

TEST(CellGrid, HostileBoxesAreRefusedWithAdvice) {
    const Box metre(Eigen::Vector3d::Zero(), Eigen::Vector3d::Ones());
    const auto message = [](const Box& box, double resolution_m) {
        return MakeGrid(box, resolution_m, kWorld).message();
    };
    for (const double resolution_m : {0.0, -1.0, 1e-9, 11.0, std::nan("")})
        EXPECT_NE(message(metre, resolution_m).find("0.001 to 10"), std::string::npos);
    EXPECT_NE(message(Box(), 0.05).find("above its minimum"), std::string::npos);
    for (const double bad : {-1.0, 0.0, 1e6, 1e300, std::nan(""), HUGE_VAL}) {
        Box box = metre;
        box.max().y() = bad;
        EXPECT_NE(message(box, 0.05).find("above its minimum"), std::string::npos) << bad;
    }
    const Box hall(Eigen::Vector3d::Zero(), Eigen::Vector3d(90000, 90000, 90000));
    EXPECT_NE(message(hall, 0.001).find("coarser resolution"), std::string::npos);
    const CellGrid large{kWorld, Eigen::Vector3i::Zero(), {600, 600, 600}, 0.05};
    EXPECT_TRUE(Padded(large, 4).ok());
    EXPECT_NE(Padded(large, 40).message().find("680 x 680 x 680"), std::string::npos);
    EXPECT_FALSE(Padded(large, 2000000000).ok());
}

TEST(CellGrid, BoundsHoldEveryVoxelInATurnedFrame) {
    BlockMap map({.voxel_size_m = 0.02, .truncation_m = 0.06});
    Eigen::Isometry3d T_world_grid = Eigen::Isometry3d::Identity();
    T_world_grid.rotate(Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized()));
    T_world_grid.translation() << 0.3, -2, 1;
    EXPECT_TRUE(BoundsOf(map, T_world_grid).isEmpty());
    map.Release(map.Allocate({50, 0, 0}));
    for (const BlockCoord& c : {BlockCoord{-3, 1, 0}, BlockCoord{2, 2, -5}}) map.Allocate(c);
    const Box bounds = BoundsOf(map, T_world_grid);
    Box voxels;
    for (BlockId id = 1; id < map.size(); ++id)
        for (int i = 0; i < kBlockVoxels && !map.IsFree(id); ++i)
            voxels.extend(T_world_grid.inverse() *
                          (0.02 * testing_support::WorldVoxel(map.coord(id), i).cast<double>()));
    EXPECT_TRUE(bounds.contains(voxels));
    EXPECT_LT((bounds.sizes() - voxels.sizes()).maxCoeff(), 0.16 * std::sqrt(3.0));
}

}  // namespace
}  // namespace tessera
