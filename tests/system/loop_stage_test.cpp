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

}  // namespace
}  // namespace tessera
