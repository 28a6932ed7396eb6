// Loops and lost cameras in a whole live run.
#include <cmath>
#include <string>
#include <string_view>
#include <vector>

#include "optimize/drifting_walk.h"
#include "optimize/pose_graph.h"
#include "scan/scan_content.h"
#include "support/temp_folder.h"
#include "system/frame_list.h"
#include "system/live_engine.h"
#include "system/map_version.h"
#include "system/place_check.h"

namespace tessera {
namespace {

using testing_support::Bias;
using testing_support::Blank;
using testing_support::FrameList;
using testing_support::RoomWalk;

EngineInput InputOf(std::vector<Frame> frames, std::atomic<bool>& stop) {
    EngineInput input;
    input.source = std::make_unique<FrameList>(std::move(frames));
    input.config.loops.enabled = true;
    input.config.live.queue_frames = 30;  // no frame of the walk is dropped, even on a slow machine
    input.config.pipeline.map = {.voxel_size_m = 0.02, .truncation_m = 0.08};
    input.config.pipeline.trackers.sdf.finest_step_px = 1;
    input.stop = &stop;
    return input;
}

TEST(Carry, AppliesWhatCameSince) {
    const std::vector<Eigen::Isometry3d> corrections{
        Eigen::Isometry3d(Eigen::Translation3d(1, 0, 0)),
        Eigen::Isometry3d(Eigen::Translation3d(0, 2, 0))};
    for (const auto& [from, expected] :
         {std::pair{0, Eigen::Vector3d(1, 2, 0)}, {1, {0, 2, 0}}, {2, {0, 0, 0}}}) {
        Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
        Carry(corrections, from, pose);
        EXPECT_EQ(pose.translation(), expected) << from;
    }
}

class KidnappedLive : public testing::TestWithParam<bool> {};

// 2 s of a walk, 1.5 s of empty frames, then a view of the beginning, repeated until the camera is
// relocalised. Where the answer takes many seconds, no new part of the scan begins meanwhile.
TEST_P(KidnappedLive, IsFound) {
    const bool slow = GetParam();
    std::vector<Frame> frames = RoomWalk(0, 60, 3);
    frames.insert(frames.end(), 45, Blank());
    const Frame again = RoomWalk(31, 1, 1).front();
    frames.insert(frames.end(), slow ? 200 : 1800, again);
    std::atomic<bool> stop{false};
    EngineInput input = InputOf({}, stop);
    auto source = std::make_unique<FrameList>(std::move(frames));
    if (slow) {
        source->SlowDown(106);
        input.config.live.playback_speed = 1000;
        input.config.live.queue_frames = 400;
    }
    const TempFolder folder;
    Result<ScanPlan> plan = BeginScan(folder / "a.scan", source->info(), input.config);
    ASSERT_TRUE(plan.ok()) << plan.message();
    input.scan = std::move(plan.value());
    input.source = std::move(source);
    LiveEngine engine(std::move(input));
    FrameOutcome outcome;
    double error_m = 1;
    std::string said;
    int waiting = 0;  // frames, for the loop thread
    while (engine.Next(outcome)) {
        said += outcome.message + "\n";
        const FrameReport& report = outcome.report;
        if (outcome.kind != FrameOutcome::Kind::kFrame || report.index < 60) continue;
        if (report.index < 105) {
            EXPECT_FALSE(report.fused) << report.index;
            continue;
        }
        if (!report.tracked()) continue;
        EXPECT_FALSE(report.first);
        for (const auto& [name, size] : outcome.queues)
            if (std::string_view(name) == "to loops")
                waiting = std::max(waiting, static_cast<int>(size));
        error_m = (report.track.T_world_camera.translation() - again.T_world_camera->translation())
                      .norm();
        stop.store(true);
    }
    EXPECT_LT(error_m, 0.02);
    EXPECT_FALSE(engine.CorrectedPath().empty());
    // If the answer came late, nothing is fused before a second view confirms the place.
    // Nor does every frame keep its images while many wait.
    if (said.find(kPlaceUnconfirmed) != std::string::npos || LoopThread::KeptOneIn(waiting) != 1)
        return;
    // The first keyframe since is linked to the one that showed the place.
    Result<ScanContent> scan = ReadScan(folder / "a.scan", {.frames = true});
    ASSERT_TRUE(scan.ok()) << scan.message();
    const std::vector<Keyframe>& keyframes = scan.value().keyframes;
    ASSERT_GE(keyframes.back().frame_index, 105);
    EXPECT_TRUE(std::ranges::any_of(scan.value().loops.edges, [&](const PoseEdge& edge) {
        const std::string frame =
            std::to_string(keyframes[static_cast<std::size_t>(edge.from)].frame_index);
        return edge.to == keyframes.back().id && !edge.loop &&
               said.find("relocalised at frame " + frame + "\n") != std::string::npos;
    })) << said;
}
INSTANTIATE_TEST_SUITE_P(Stamps, KidnappedLive, testing::Bool());

constexpr std::int64_t kMostFrames = 20000;  // ten minutes

// After the frames of the list the camera stands still.
class ThenStandsStill : public FrameList {
  public:
    using FrameList::FrameList;

    ReadResult Read(Frame& frame) override {
        if (FrameList::Read(frame).status == ReadStatus::kOk) {
            last_ = frame;
            return {};
        }
        if (++last_.index >= kMostFrames) return {ReadStatus::kEnd, {}};
        last_.stamp_s = last_.colour_stamp_s = static_cast<double>(last_.index) / 30;
        frame = last_;
        return {};
    }

  private:
    Frame last_;
};

// A round with odometry that drifts. At its end the camera stands still until the map in use has
// followed the corrected path, however long that takes.
TEST(LiveEngineWithLoops, TheMapFollowsDuringTheRun) {
    if (!PoseGraphAvailable()) GTEST_SKIP() << "this build has no Ceres: install libceres-dev";
    const std::vector<Frame> walk = testing_support::Round();
    std::vector<StampedPose> drifted;
    for (std::size_t i = 0; i < kMostFrames; ++i) {
        Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
        if (i > 0) T_world_camera = drifted.back().T_world_camera;
        if (i > 0 && i < walk.size())
            T_world_camera = Normalised(T_world_camera * walk[i - 1].T_world_camera->inverse() *
                                        *walk[i].T_world_camera * Bias());
        drifted.push_back({static_cast<double>(i) / 30, T_world_camera});
    }
    std::atomic<bool> stop{false};
    EngineInput input = InputOf({}, stop);
    input.source = std::make_unique<ThenStandsStill>(walk);
    input.plan = FramePlan({}, drifted, "poses");
    LiveEngine engine(std::move(input));
    FrameOutcome outcome;
    std::int64_t latest = 0, corrected_at = -1;  // frames
    while (engine.Next(outcome)) {
        if (outcome.kind == FrameOutcome::Kind::kFrame) latest = outcome.report.index;
        if (outcome.message == "map corrected" && corrected_at < 0) corrected_at = latest;
        stop.store(corrected_at >= 0);
    }
    ASSERT_GE(corrected_at, 0);
    EXPECT_LT(corrected_at, kMostFrames - 1);  // not only at the end
    // Of the last frame of the round. Given poses do not follow the map: later ones are wrong
    // again.
    StampedPose last;
    for (const StampedPose& pose : engine.CorrectedPath())
        if (pose.stamp_s < static_cast<double>(walk.size()) / 30 - 0.01) last = pose;
    const auto index = static_cast<std::size_t>(std::lround(30 * last.stamp_s));
    ASSERT_GT(index + 20, walk.size());
    const auto off_m = [&](const Eigen::Isometry3d& pose) {
        return (pose.translation() - walk[index].T_world_camera->translation()).norm();
    };
    const double before_m = off_m(drifted[index].T_world_camera);
    EXPECT_GT(before_m, 0.06);
    EXPECT_LT(off_m(last.T_world_camera), before_m / 3);
    EXPECT_GT(engine.TakeMesh().triangles.size(), 10000u);
}

}  // namespace
}  // namespace tessera
