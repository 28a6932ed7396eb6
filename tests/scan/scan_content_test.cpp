#include "scan/scan_content.h"

#include <gtest/gtest.h>

namespace tessera {
namespace {

Eigen::Isometry3d At(double x_m) { return Eigen::Isometry3d(Eigen::Translation3d(x_m, 0.1, 0.2)); }

// A scan whose run was killed: the first part, a second that was joined with it but is still far
// away in the map, a third that nothing joins, and frames that loop closure had not yet looked at.
class KilledRunsScan : public testing::Test {
  protected:
    void AddKeyframe(double in_map_m, double in_world_m, bool left_out) {
        Keyframe keyframe;
        keyframe.id = static_cast<int>(std::ssize(scan.keyframes));
        keyframe.T_map_camera = At(in_map_m);
        keyframe.T_world_camera = At(in_world_m);
        scan.keyframes.push_back(keyframe);
        scan.left_out.push_back(left_out);
    }
    void AddFrame(int keyframe, double x_m, TrackStatus status = TrackStatus::kGood) {
        PathRecord record;
        record.stamp_s = static_cast<double>(scan.path.size());
        record.status = status;
        record.keyframe = keyframe;
        record.T_reference_camera = Eigen::Isometry3d(Eigen::Translation3d(x_m, 0, 0));
        scan.path.push_back(record);
    }
    void SetUp() override {
        AddKeyframe(1, 1, false);
        AddKeyframe(1002, 2, false);
        AddKeyframe(2003, 2003, true);
        AddFrame(0, 0.1);
        AddFrame(1, 0.1);
        AddFrame(2, 0.1);
        AddFrame(0, 0.2, TrackStatus::kLost);
        AddFrame(-1, 1.5);
        AddFrame(-1, 2004);
        scan.map = std::make_unique<BlockMap>(
            BlockMap::Config{.voxel_size_m = 0.01, .truncation_m = 0.04});
        for (const int x_m : {0, 3, -200, 1002, 2003}) scan.map->Allocate(BlockAt(x_m));
    }
    static BlockCoord BlockAt(int x_m) { return {x_m * 100 / kBlockSide, 0, 0}; }
    bool Has(int x_m) const { return scan.map->Find(BlockAt(x_m)) != kUnknownBlock; }

    ScanContent scan;
};

TEST_F(KilledRunsScan, ShowsOnlyWhatIsInPlace) {
    scan.RemoveHiddenBlocks();
    EXPECT_TRUE(Has(0) && Has(3) && Has(-200));
    EXPECT_FALSE(Has(1002));
    EXPECT_FALSE(Has(2003));
    EXPECT_EQ(scan.map->count(), 3);
}

TEST_F(KilledRunsScan, HasPosesOfAllThatIsJoined) {
    std::vector<double> stamps, xs_m;
    for (const StampedPose& pose : scan.Path()) {
        stamps.push_back(pose.stamp_s);
        xs_m.push_back(pose.T_world_camera.translation().x());
    }
    EXPECT_EQ(stamps, (std::vector<double>{0, 1, 4}));
    ASSERT_EQ(xs_m.size(), 3u);
    EXPECT_NEAR(xs_m[1], 2.1, 1e-9);  // where the graph has it
}

TEST_F(KilledRunsScan, WithoutLoopClosureAllIsShown) {
    scan.keyframes.clear();
    scan.left_out.clear();
    scan.path.erase(scan.path.begin(), scan.path.begin() + 4);
    scan.RemoveHiddenBlocks();
    EXPECT_EQ(scan.map->count(), 5);
    EXPECT_EQ(scan.Path().size(), 2u);
    scan.map.reset();
    scan.RemoveHiddenBlocks();  // read without its map
}

}  // namespace
}  // namespace tessera
