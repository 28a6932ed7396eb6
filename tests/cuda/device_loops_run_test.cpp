// Loop closure with the host device: the frame data that it needs is copied back.
#include "cuda/desk_frames.h"
#include "cuda/device_pipeline.h"
#include "system/frame_list.h"
#include "system/lockstep_engine.h"

namespace tessera::host {
namespace {

using namespace testing_support;

std::vector<FrameReport> RunFrames(const std::vector<Frame>& frames, Backend* device) {
    const std::atomic<bool> stop{false};
    EngineInput input;
    input.config.loops.enabled = true;
    input.config.pipeline.map = {.voxel_size_m = 0.02, .truncation_m = 0.08};
    input.source = std::make_unique<FrameList>(frames);
    input.stop = &stop;
    input.device = device;
    LockstepEngine engine(std::move(input));
    std::vector<FrameReport> reports;
    FrameOutcome frame;
    while (engine.Next(frame))
        if (frame.kind == FrameOutcome::Kind::kFrame) reports.push_back(frame.report);
    return reports;
}

// 2 s of a walk, 1.5 s of empty frames, then the middle of the walk again. The camera is
// relocalised by its features, as it is on the CPU alone.
TEST(DeviceLoops, AKidnappedCameraIsFoundAsByTheProcessor) {
    std::vector<Frame> frames = RoomWalk(0, 60, 3);
    frames.insert(frames.end(), 45, Blank());
    for (const Frame& frame : RoomWalk(31, 20, 1)) frames.push_back(frame);
    const std::vector<FrameReport> expected = RunFrames(frames, nullptr);
    DevicePipeline device("host", kPlenty);
    const std::vector<FrameReport> reports = RunFrames(frames, &device);
    ASSERT_EQ(reports.size(), frames.size());
    for (std::size_t i = 0; i < frames.size(); ++i)
        ExpectSameTrack(reports[i].track, expected[i].track, i);
    EXPECT_FALSE(reports[104].tracked());
    EXPECT_TRUE(reports.back().tracked()) << reports.back().track.reason;
}

}  // namespace
}  // namespace tessera::host
