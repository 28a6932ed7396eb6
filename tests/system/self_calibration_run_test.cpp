// Complete runs with calibration.refine, in a rendered room with Kinect noise, 320 x 240.
#include "eval/ate.h"
#include "system/frame_list.h"
#include "system/live_engine.h"
#include "system/lockstep_engine.h"

namespace tessera {
namespace {

using testing_support::FrameList;
using testing_support::RoomCamera;
using testing_support::RoomWalk;

class OffCamera : public FrameList {
  public:
    OffCamera(const std::vector<Frame>& frames, double focal_scale)
        : FrameList(frames), info_(FrameList::info()) {
        info_.camera = Corrected(info_.camera, {focal_scale, 0});
    }
    const SourceInfo& info() const override { return info_; }

  private:
    SourceInfo info_;
};

struct RoomOutcome {
    double ate_m = 0;
    std::optional<CalibrationReport> calibration;
    std::string messages;
    TriangleMesh mesh;
};

const std::vector<Frame>& Frames() {
    static const std::vector<Frame> frames = RoomWalk(0, 180, 4);
    return frames;
}

EngineInput InputOf(double focal_scale, bool refine) {
    static const std::atomic<bool> kStop{false};
    EngineInput input;
    input.source = std::make_unique<OffCamera>(Frames(), focal_scale);
    input.config.loops.enabled = true;
    input.config.loops.refine_calibration = refine;
    input.config.pipeline.map = {.voxel_size_m = 0.02, .truncation_m = 0.08};
    input.stop = &kStop;
    return input;
}

RoomOutcome RunRoom(double focal_scale, bool refine) {
    LockstepEngine engine(InputOf(focal_scale, refine));
    const std::vector<Frame>& frames = Frames();
    RoomOutcome outcome;
    FrameOutcome frame;
    while (engine.Next(frame))
        if (frame.kind == FrameOutcome::Kind::kMessage) outcome.messages += frame.message + "\n";
    std::vector<StampedPose> truth;
    for (std::size_t i = 0; i < frames.size(); ++i)
        truth.push_back({static_cast<double>(i) / 30, *frames[i].T_world_camera});
    const auto ate = EvaluateAte(truth, engine.CorrectedPath(),
                                 {.frames = static_cast<std::int64_t>(frames.size())});
    EXPECT_TRUE(ate.ok()) << ate.message();
    if (ate.ok()) outcome.ate_m = ate.value().error_m.rmse;
    outcome.calibration = engine.calibration();
    outcome.mesh = engine.TakeMesh();
    return outcome;
}

TEST(SelfCalibrationRun, AFocalLengthThatIsOffIsFoundAndThePathFollows) {
    if (!PoseGraphAvailable()) GTEST_SKIP() << "this build has no Ceres: install libceres-dev";
    const RoomOutcome before = RunRoom(0.97, false), after = RunRoom(0.97, true);
    EXPECT_FALSE(before.calibration);
    ASSERT_TRUE(after.calibration);
    std::cout << after.messages << "ATE " << 1000 * before.ate_m << " -> " << 1000 * after.ate_m
              << " mm\n";
    EXPECT_TRUE(after.calibration->shown);
    EXPECT_NEAR(0.97 * after.calibration->calibration.focal_scale, 1,
                3 * after.calibration->focal_sigma);
    EXPECT_LT(after.ate_m, before.ate_m / 3);
    EXPECT_NE(after.messages.find("calibration: focal length 254.6 -> 26"), std::string::npos);
}

TEST(SelfCalibrationRun, AGoodOneStaysAndTheMapIsTheSameByteForByte) {
    if (!PoseGraphAvailable()) GTEST_SKIP() << "this build has no Ceres: install libceres-dev";
    const RoomOutcome before = RunRoom(1, false), after = RunRoom(1, true);
    ASSERT_TRUE(after.calibration) << after.messages;
    EXPECT_FALSE(after.calibration->shown) << after.messages;
    EXPECT_EQ(after.ate_m, before.ate_m);
    ASSERT_EQ(after.mesh.vertices.size(), before.mesh.vertices.size());
    for (std::size_t i = 0; i < after.mesh.vertices.size(); ++i)
        ASSERT_EQ(after.mesh.vertices[i], before.mesh.vertices[i]);
}

// How many frames a live run keeps depends on the machine, and so does the result. But it must
// always try to calibrate and report the result.
TEST(SelfCalibrationRun, ALiveRunLooksAtItsEnd) {
    if (!PoseGraphAvailable()) GTEST_SKIP() << "this build has no Ceres: install libceres-dev";
    LiveEngine engine(InputOf(0.97, true));
    std::string messages;
    FrameOutcome frame;
    while (engine.Next(frame))
        if (frame.kind == FrameOutcome::Kind::kMessage) messages += frame.message + "\n";
    EXPECT_NE(messages.find("calibration: "), std::string::npos) << messages;
    const auto found = engine.calibration();
    EXPECT_TRUE(!found || !found->shown ||
                std::abs(0.97 * found->calibration.focal_scale - 1) < 0.01)
        << messages;
    EXPECT_FALSE(engine.TakeMesh().triangles.empty());
}

}  // namespace
}  // namespace tessera
