// Kidnapped cameras and complete runs with loop closure, in a rendered room with Kinect noise.
#include "system/loop_stage.h"

#include <tbb/global_control.h>

#include "system/frame_list.h"
#include "system/lockstep_engine.h"

namespace tessera {
namespace {

using testing_support::Blank;
using testing_support::FrameList;
using testing_support::RoomWalk;

struct Outcome {
    std::vector<FrameReport> reports;
    std::vector<StampedPose> path;
    TriangleMesh mesh;
};

Outcome RunFrames(const std::vector<Frame>& frames, bool loops = true) {
    RunConfig config;
    config.loops.enabled = loops;
    config.pipeline.map = {.voxel_size_m = 0.02, .truncation_m = 0.08};
    config.pipeline.trackers.sdf.finest_step_px = 1;
    const std::atomic<bool> stop{false};
    EngineInput input;
    input.source = std::make_unique<FrameList>(frames);
    input.config = config;
    input.stop = &stop;
    LockstepEngine engine(std::move(input));
    Outcome outcome;
    FrameOutcome frame;
    while (engine.Next(frame))
        if (frame.kind == FrameOutcome::Kind::kFrame) outcome.reports.push_back(frame.report);
    outcome.path = engine.CorrectedPath();
    outcome.mesh = engine.TakeMesh();
    return outcome;
}

// 2 s of the walk, 1.5 s of empty frames, then the frames in `then`.
std::vector<Frame> Kidnap(const std::vector<Frame>& then) {
    std::vector<Frame> frames = RoomWalk(0, 60, 3);
    frames.insert(frames.end(), 45, Blank());
    frames.insert(frames.end(), then.begin(), then.end());
    return frames;
}

TEST(LoopStage, AKidnappedCameraIsFoundWithinTenFrames) {
    const std::vector<Frame> again = RoomWalk(31, 20, 1), frames = Kidnap(again);
    const Outcome outcome = RunFrames(frames);
    ASSERT_EQ(outcome.reports.size(), frames.size());
    for (std::size_t i = 60; i < 105; ++i) {
        EXPECT_FALSE(outcome.reports[i].tracked());
        EXPECT_FALSE(outcome.reports[i].fused);
    }
    std::size_t first = 105;
    while (first < frames.size() && !outcome.reports[first].tracked()) ++first;
    EXPECT_LE(first, 115u);
    double squares = 0;
    int tracked = 0;
    for (std::size_t i = 0; i < frames.size(); ++i) {
        if (!outcome.reports[i].tracked()) continue;
        const double off_m = (outcome.reports[i].track.T_world_camera.translation() -
                              frames[i].T_world_camera->translation())
                                 .norm();
        squares += off_m * off_m;
        ++tracked;
    }
    std::cout << "found after " << first - 105 << " frames; " << tracked << " tracked, rms "
              << 1000 * std::sqrt(squares / tracked) << " mm\n";
    EXPECT_GE(tracked, 60 + 10);
    EXPECT_LE(std::sqrt(squares / tracked), 0.02);
}

TEST(LoopStage, AnUnknownPlaceStaysLostAndTheMapStaysByteForByte) {
    const Outcome before = RunFrames(Kidnap({})), after = RunFrames(Kidnap(RoomWalk(360, 20, 3)));
    for (std::size_t i = 60; i < after.reports.size(); ++i) {
        EXPECT_FALSE(after.reports[i].tracked()) << i;
        EXPECT_FALSE(after.reports[i].fused) << i;
    }
    EXPECT_EQ(after.mesh.vertices, before.mesh.vertices);
    EXPECT_EQ(after.mesh.colours, before.mesh.colours);
    EXPECT_EQ(after.mesh.triangles, before.mesh.triangles);
}

TEST(LoopStage, TheSameBytesForAnyNumberOfThreads) {
    const std::vector<Frame> frames = Kidnap(RoomWalk(31, 10, 1));
    Outcome outcomes[2];
    for (int threads : {1, 3}) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                                        static_cast<std::size_t>(threads));
        outcomes[threads / 2] = RunFrames(frames);
    }
    ASSERT_EQ(outcomes[0].path.size(), outcomes[1].path.size());
    for (std::size_t i = 0; i < outcomes[0].path.size(); ++i)
        EXPECT_EQ(outcomes[0].path[i].T_world_camera.matrix(),
                  outcomes[1].path[i].T_world_camera.matrix())
            << i;
    EXPECT_EQ(outcomes[0].mesh.vertices, outcomes[1].mesh.vertices);
    EXPECT_EQ(outcomes[0].mesh.colours, outcomes[1].mesh.colours);
}

// If there is no drift, loop closure changes nothing.
TEST(LoopStage, AWalkWithoutDriftIsTheSameWithAndWithout) {
    const std::vector<Frame> frames = RoomWalk(0, 60, 3);
    const Outcome with = RunFrames(frames), without = RunFrames(frames, false);
    EXPECT_TRUE(without.path.empty());
    for (std::size_t i = 0; i < frames.size(); ++i)
        EXPECT_EQ(with.reports[i].track.T_world_camera.matrix(),
                  without.reports[i].track.T_world_camera.matrix())
            << i;
    EXPECT_EQ(with.mesh.vertices, without.mesh.vertices);
}

// It is tracked poorly for so long that it is looked for, and what it sees is found nowhere.
TEST(LoopStage, ADoubtfulCameraFusesNothingWhileItsPlaceIsChecked) {
    RunConfig config;
    config.pipeline.map = {.voxel_size_m = 0.02, .truncation_m = 0.08};
    config.pipeline.trackers.sdf.finest_step_px = 1;
    SourceInfo source;
    source.camera = testing_support::RoomCamera();
    TrackingStage tracking(config.pipeline, source.camera);
    LoopStage loops(config.loops, config.pipeline, source, std::nullopt, {});
    BlockMap map(config.pipeline.map);
    Integrator integrator(config.pipeline.fusion, source.camera);
    TrackedFrame tracked;
    std::int64_t index = 0;
    const auto go = [&](Frame frame, const PreparedFrame* poorly_seen) {
        frame.index = index++;
        frame.stamp_s = frame.colour_stamp_s = static_cast<double>(index) / 30;
        tracking.Track(frame, map, std::nullopt, tracked);
        if (poorly_seen != nullptr) {
            tracked.prepared = *poorly_seen;
            tracked.report.track.status = TrackStatus::kPoor;
            tracked.to_fuse = true;
        }
        loops.AfterTracking(frame, map, tracking, tracked, [](const auto&) {});
        tracked.report.fused = tracked.to_fuse;
        if (tracked.to_fuse) integrator.Integrate(tracked.prepared, tracked.view, map);
        loops.AfterFusion(frame, tracked, std::nullopt, tracking, [](auto) {});
    };
    for (const Frame& frame : RoomWalk(0, 60, 3)) go(frame, nullptr);
    ASSERT_TRUE(tracked.report.fused);
    for (int i = 0; i < 75; ++i) go(Blank(), nullptr);
    const Frame again = RoomWalk(31, 1, 1).front();
    go(again, nullptr);
    ASSERT_TRUE(tracked.report.tracked());
    ASSERT_NE(tracked.report.warning.find(kPlaceUnconfirmed), std::string::npos);
    PreparedFrame unknown;
    PrepareFrame(RoomWalk(360, 1, 1).front(), config.pipeline.frame, unknown);
    for (int i = 0; i < 25; ++i) {
        go(again, &unknown);
        EXPECT_FALSE(tracked.report.fused) << i;
    }
}

}  // namespace
}  // namespace tessera
