// Correction of maps under a memory limit: a rendered room with Kinect noise, at poses that drift
// until loops are closed.
#include <sys/resource.h>

#include <csignal>

#include "optimize/pose_graph.h"
#include "run/scan_export.h"
#include "support/temp_folder.h"
#include "system/frame_list.h"
#include "system/live_engine.h"
#include "system/lockstep_engine.h"

namespace tessera {
namespace {

using testing_support::FrameList;
using testing_support::RoomCamera;

constexpr double kLimit_mb = 55;  // the whole map takes 80 MB

// Once around through two rooms, and back into the first.
std::vector<Frame> Tour() {
    constexpr int kTourFrames = 120, kTourStep = 18;
    SynthConfig config;
    config.camera = RoomCamera();
    config.sensor.noise = NoiseModel::kKinect;
    const auto source = OpenSynthetic("flat", config);
    EXPECT_TRUE(source.ok());
    static std::vector<Frame> frames;
    for (int i = static_cast<int>(frames.size()); i < kTourFrames; ++i) {
        source.value()->Seek(i * kTourStep);
        source.value()->Read(frames.emplace_back());
    }
    return frames;
}

class PagingLoops : public testing::Test {
  protected:
    PagingLoops() {
        config.loops.enabled = true;
        config.loops.rebuild_frames = 60;
        config.scan.interval_s = 0.2;
        config.live.queue_frames = 100;
        config.live.playback_speed = 0.3;
        config.pipeline.map = {.voxel_size_m = 0.02, .truncation_m = 0.08};
        config.pipeline.frame.max_depth_m = 3;
        config.pipeline.trackers.sdf.finest_step_px = 1;
    }
    void SetUp() override {
        if (!PoseGraphAvailable()) GTEST_SKIP() << "this build has no Ceres: install libceres-dev";
    }
    void Start(const std::vector<Frame>& frames, bool live, double limit_mb) {
        config.pipeline.memory_limit_mb = limit_mb;
        std::remove(path.c_str());
        EngineInput input;
        input.source = std::make_unique<FrameList>(frames);
        input.plan = FramePlan({}, Drifted(frames), "poses");
        input.config = config;
        input.stop = &stop;
        Result<ScanPlan> plan = BeginScan(path, input.source->info(), config);
        EXPECT_TRUE(plan.ok()) << plan.message();
        input.scan = std::move(plan.value());
        if (live)
            engine = std::make_unique<LiveEngine>(std::move(input));
        else
            engine = std::make_unique<LockstepEngine>(std::move(input));
        reports.clear();
        said.clear();
        corrections = 0;
        most_bytes = 0;
        most_blocks = 0;
    }
    bool Next() {
        FrameOutcome outcome;
        if (!engine->Next(outcome)) return false;
        if (!outcome.message.empty()) said += outcome.message + "\n";
        if (outcome.kind == FrameOutcome::Kind::kFrame) {
            reports.push_back(outcome.report);
            if (!outcome.report.warning.empty()) said += outcome.report.warning + "\n";
            corrections += outcome.report.warning.find("map corrected") != std::string::npos;
            most_bytes = std::max(most_bytes, outcome.map.bytes);
            most_blocks = std::max(most_blocks, outcome.map.blocks);
        }
        return true;
    }
    TriangleMesh Run(const std::vector<Frame>& frames, bool live, double limit_mb) {
        Start(frames, live, limit_mb);
        while (Next()) {
        }
        EXPECT_TRUE(engine->status().ok()) << engine->status().message();
        path_at_end = engine->CorrectedPath();
        blocks_at_end = engine->map_statistics().blocks;
        TriangleMesh mesh = engine->TakeMesh();
        EXPECT_TRUE(engine->status().ok()) << engine->status().message();
        return mesh;
    }
    // Odometry with a small constant rotation and translation error at each step.
    static std::vector<StampedPose> Drifted(const std::vector<Frame>& frames) {
        const Eigen::Isometry3d bias =
            Se3Exp((Vector6d() << 0, 0.0009, 0, 0.0015, 0, 0).finished());
        std::vector<StampedPose> poses;
        for (std::size_t i = 0; i < frames.size(); ++i) {
            Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
            if (i > 0)
                T_world_camera = Normalised(poses.back().T_world_camera *
                                            frames[i - 1].T_world_camera->inverse() *
                                            *frames[i].T_world_camera * bias);
            poses.push_back({static_cast<double>(i) / 30, T_world_camera});
        }
        return poses;
    }
    static void ExpectSame(const TriangleMesh& a, const TriangleMesh& b) {
        ASSERT_EQ(a.vertices.size(), b.vertices.size());
        EXPECT_TRUE(a.vertices == b.vertices);
        EXPECT_TRUE(a.colours == b.colours);
        EXPECT_TRUE(a.triangles == b.triangles);
    }

    RunConfig config;
    std::atomic<bool> stop{false};
    TempFolder folder;
    std::string path = folder / "a.scan";
    std::unique_ptr<Engine> engine;
    std::vector<FrameReport> reports;
    std::string said;
    std::vector<StampedPose> path_at_end;
    std::size_t most_bytes = 0;
    std::int64_t most_blocks = 0, blocks_at_end = 0;
    int corrections = 0;
};

TEST_F(PagingLoops, ACorrectedMapIsTheSameWithALimit) {
    const std::vector<Frame> walk = Tour();
    const TriangleMesh whole = Run(walk, false, 0);
    const auto reports_whole = reports;
    const auto path_whole = path_at_end;
    const int corrections_whole = corrections;
    const std::int64_t blocks = blocks_at_end;
    ASSERT_GE(corrections_whole, 1);
    const TriangleMesh mesh = Run(walk, false, kLimit_mb);
    EXPECT_EQ(corrections, corrections_whole);
    EXPECT_LT(4 * most_blocks, 3 * blocks);
    EXPECT_LT(static_cast<double>(most_bytes), 1e6 * kLimit_mb);
    EXPECT_EQ(said.find("memory_limit"), std::string::npos);
    ASSERT_EQ(reports.size(), reports_whole.size());
    for (std::size_t i = 0; i < reports.size(); ++i)
        EXPECT_EQ(reports[i].track.T_world_camera.matrix(),
                  reports_whole[i].track.T_world_camera.matrix())
            << i;
    ASSERT_EQ(path_at_end.size(), path_whole.size());
    for (std::size_t i = 0; i < path_at_end.size(); ++i)
        EXPECT_EQ(path_at_end[i].T_world_camera.matrix(), path_whole[i].T_world_camera.matrix())
            << i;
    ExpectSame(mesh, whole);
    Result<ScanContent> scan = ReadScan(path, {.map = true, .frames = true});
    ASSERT_TRUE(scan.ok()) << scan.message();
    EXPECT_EQ(scan.value().map->count(), blocks);
    const Result<TriangleMesh> exported = MeshOfScan(scan.value());
    ASSERT_TRUE(exported.ok()) << exported.message();
    ExpectSame(exported.value(), whole);
    // This limit is below what the camera may see from one position. Everything else is paged out
    // at once and returns at the end of the tour.
    ExpectSame(Run(walk, false, 20), whole);
}

// Acts like a full disk from the first loop on: neither the scan nor the corrected map can be
// written.
TEST_F(PagingLoops, AFullDiskWhileTheMapIsMadeAgainLeavesTheMapAndCorrectsThePath) {
    const std::vector<Frame> walk = Tour();
    config.loops.enabled = false;
    const TriangleMesh whole = Run(walk, false, 0);
    config.loops.enabled = true;
    Start(walk, false, kLimit_mb);
    std::signal(SIGXFSZ, SIG_IGN);
    rlimit before{};
    ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
    bool full = false;
    while (Next()) {
        if (full || said.find("loop closed") == std::string::npos) continue;
        full = true;
        // SQLite needs this much for its journal index, which already exists.
        const rlimit little{1 << 16, before.rlim_max};
        ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &little), 0);
    }
    ASSERT_TRUE(full) << said;
    EXPECT_TRUE(engine->status().ok()) << engine->status().message();
    const auto path_found = engine->CorrectedPath();
    const TriangleMesh mesh = engine->TakeMesh();
    ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &before), 0);
    EXPECT_TRUE(engine->status().ok()) << engine->status().message();
    const std::string given_up = "map correction stopped";
    const std::size_t at = said.find(given_up);
    ASSERT_NE(at, std::string::npos) << said;
    EXPECT_EQ(said.find(given_up, at + 1), std::string::npos) << said;
    EXPECT_NE(said.find("no longer saved"), std::string::npos) << said;
    EXPECT_EQ(corrections, 0);
    EXPECT_EQ(mesh.vertices.size(), whole.vertices.size());
    EXPECT_EQ(mesh.triangles.size(), whole.triangles.size());
    const auto off_m = [&](const Eigen::Isometry3d& T_world_camera) {
        const Eigen::Isometry3d truth =
            walk.front().T_world_camera->inverse() * *walk.back().T_world_camera;
        return (T_world_camera.translation() - truth.translation()).norm();
    };
    EXPECT_LT(off_m(path_found.back().T_world_camera),
              0.5 * off_m(Drifted(walk).back().T_world_camera));
}

// Which frames are fused depends on thread timing. The final map must be complete.
TEST_F(PagingLoops, LiveTheMapIsCorrectedAndWhole) {
    config.live.playback_speed = 0.3;
    const TriangleMesh mesh = Run(Tour(), true, kLimit_mb);
    EXPECT_EQ(said.find("scan repair"), std::string::npos) << said;
    EXPECT_GT(mesh.triangles.size(), 100000u);
    const Result<ScanContent> scan = ReadScan(path, {.map = true, .frames = true});
    ASSERT_TRUE(scan.ok()) << scan.message();
    EXPECT_GE(scan.value().map->count(), blocks_at_end);
    if (said.find("map corrected") == std::string::npos)
        GTEST_SKIP() << "the machine is too slow: no loop was closed";
}

}  // namespace
}  // namespace tessera
