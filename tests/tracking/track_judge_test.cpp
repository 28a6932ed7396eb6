#include "tracking/track_judge.h"

#include <gtest/gtest.h>

#include <tuple>
#include <utility>

#include "mapping/block_map.h"
#include "mapping/prepared_frame.h"

namespace tessera {
namespace {

// If frames between were lost, it can have moved farther.
TEST(TrackJudge, AllowsAJumpForEachFrameSinceTheLastPose) {
    const BlockMap map({});
    const PreparedFrame frame;
    const TrackJudge judge(TrackJudge::Config{.max_jump_m = 0.3, .max_jump_rad = 0.5});
    const auto status_after = [&](double moved_m, int frames) {
        const Eigen::Isometry3d T_moved(Eigen::Translation3d(moved_m, 0, 0));
        TrackResult result{.T_world_camera = T_moved, .inlier_fraction = 1};
        judge.Judge({.frame = frame,
                     .map = map,
                     .T_world_camera_starts = {T_moved},
                     .T_world_camera_last = Eigen::Isometry3d::Identity(),
                     .since_last_s = 0.03 * frames,
                     .frames_since_last = frames},
                    result);
        EXPECT_EQ(result.unexpected, result.status == TrackStatus::kLost);  // may be confirmed
        return result.status;
    };
    EXPECT_EQ(status_after(0.29, 1), TrackStatus::kGood);
    EXPECT_EQ(status_after(0.31, 1), TrackStatus::kLost);
    EXPECT_EQ(status_after(0.31, 2), TrackStatus::kGood);
    EXPECT_EQ(status_after(0.61, 2), TrackStatus::kLost);
}

// Half a voxel, but never less than 5 mm.
TEST(TrackJudge, SmallVoxelsLeaveNoMotionOpen) {
    const PreparedFrame frame;
    for (const auto& [voxel_m, limit_m] :
         {std::pair{0.002, 0.005}, {0.004, 0.005}, {0.01, 0.005}, {0.02, 0.01}}) {
        const BlockMap map({.voxel_size_m = voxel_m, .truncation_m = 4 * voxel_m});
        for (const double share : {0.99, 1.01}) {
            TrackResult result{.inlier_fraction = 1, .uncertainty_m = share * limit_m};
            TrackJudge({}).Judge({.frame = frame,
                                  .map = map,
                                  .T_world_camera_starts = {Eigen::Isometry3d::Identity()},
                                  .T_world_camera_last = Eigen::Isometry3d::Identity()},
                                 result);
            EXPECT_EQ(result.degenerate, share > 1) << voxel_m << " m";
        }
    }
}

// Far from the prediction, a pose is poor. A frame that knows all motions well can prove it right.
TEST(TrackJudge, SaysWhatIsUnexpected) {
    const BlockMap map({.voxel_size_m = 0.02, .truncation_m = 0.08});
    const PreparedFrame frame;
    const TrackJudge judge(TrackJudge::Config{
        .degenerate_voxels = 0.5, .good_innovation_m = 0.2, .good_innovation_rad = 0.35});
    for (const auto& [x_m, uncertainty_m, unexpected] :
         {std::tuple{0.21, 0.009, true}, {0.21, 0.011, false}, {0.19, 0.009, false}}) {
        const Eigen::Isometry3d T_moved(Eigen::Translation3d(x_m, 0, 0));
        TrackResult result{
            .T_world_camera = T_moved, .inlier_fraction = 1, .uncertainty_m = uncertainty_m};
        judge.Judge({.frame = frame,
                     .map = map,
                     .T_world_camera_starts = {Eigen::Isometry3d::Identity()},
                     .T_world_camera_last = T_moved,
                     .since_last_s = 0.03},
                    result);
        EXPECT_EQ(result.unexpected, unexpected) << x_m << " m, " << uncertainty_m;
        EXPECT_EQ(result.status, x_m > 0.2 ? TrackStatus::kPoor : TrackStatus::kGood);
        EXPECT_NEAR(result.innovation_share, x_m / 0.2, 1e-12);
    }
    TrackResult still{.inlier_fraction = 1};
    TrackJudge(TrackJudge::Config{.good_innovation_m = 0, .good_innovation_rad = 0})
        .Judge({.frame = frame,
                .map = map,
                .T_world_camera_starts = {Eigen::Isometry3d::Identity()},
                .T_world_camera_last = Eigen::Isometry3d::Identity()},
               still);
    EXPECT_EQ(still.innovation_share, 0);
    EXPECT_EQ(still.status, TrackStatus::kGood);
}

}  // namespace
}  // namespace tessera
