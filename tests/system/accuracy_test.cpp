// Accuracy of the whole program on sequences with ground truth: default settings, every frame,
// SE(3) alignment without scale. The bounds are the project's requirements, not the current
// results, which are in docs/benchmarks/README.md.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "eval/alignment.h"
#include "eval/mesh_error.h"
#include "io/mesh_io.h"
#include "io/trajectory.h"
#include "run/run.h"
#include "support/temp_folder.h"

namespace tessera {
namespace {

namespace fs = std::filesystem;

std::string DataFolder(const std::string& name) {
    const char* data = std::getenv("TESSERA_DATA");
    return (data != nullptr ? std::string(data)
                            : std::string(TESSERA_SOURCE_DIR) + "/../shared/data") +
           "/" + name;
}

std::string ReadAll(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    std::stringstream text;
    text << file.rdbuf();
    return text.str();
}

RunSummary RunWith(const RunConfig& config, const std::string& source, const std::string& out,
                   const FrameSelection& selection = {}) {
    RunRequest request;
    request.source = source;
    request.output_folder = out;
    request.selection = selection;
    const std::atomic<bool> stop{false};
    const auto run = ExecuteRun(request, config, {}, stop);
    EXPECT_TRUE(run.ok()) << run.message();
    return run.ok() ? run.value() : RunSummary{};
}

RunSummary RunOn(const std::string& source, const std::string& out, std::int64_t stride = 1,
                 int threads = 0, std::int64_t count = -1,
                 TrackingMethod method = TrackingMethod::kSdf) {
    RunConfig config;
    config.threads = threads;
    config.pipeline.trackers.method = method;
    return RunWith(config, source, out, {.count = count, .stride = stride});
}

class Recorded : public testing::Test {
  protected:
    // Sets `sequence` to the folder of the sequence, and skips the test if it is absent.
    void Need(const std::string& name) {
        sequence = DataFolder(name);
        if (!fs::exists(sequence))
            GTEST_SKIP() << sequence << " is absent: set TESSERA_DATA to a folder that holds "
                         << name
                         << " (TUM RGB-D sequences: cvg.cit.tum.de/data/datasets/rgbd-dataset)";
    }
    TempFolder folder;
    std::string sequence;
};

TEST_F(Recorded, Freiburg1RpyIsTrackedToTwoCentimetres) {
    ASSERT_NO_FATAL_FAILURE(Need("tum_fr1_rpy"));
    if (IsSkipped()) return;
    const RunSummary run = RunOn(sequence, folder / "out");
    // All of 722 but two, whose colours are nearer in time to others' depth once the delay is
    // corrected; 694 by the stamps as recorded.
    EXPECT_EQ(run.counts.frames, 720);
    EXPECT_EQ(run.counts.tracked, 720);
    ASSERT_TRUE(run.ate.has_value());
    EXPECT_LE(run.ate->error_m.rmse, 0.022);
    EXPECT_LE(run.map.bytes_per_voxel, 12.0);
}

// Six frames per second. The camera turns by up to 22 degrees between two frames.
TEST_F(Recorded, Freiburg1RpyIsTrackedAtAFifthOfItsRate) {
    ASSERT_NO_FATAL_FAILURE(Need("tum_fr1_rpy"));
    if (IsSkipped()) return;
    const RunSummary run = RunOn(sequence, folder / "out", 5);
    EXPECT_EQ(run.counts.tracked, run.counts.frames);
    ASSERT_TRUE(run.ate.has_value());
    EXPECT_LE(run.ate->error_m.rmse, 0.022);
}

struct House {
    const char* name;
    double ate_m;
    double surface_m = 0;  // bound on the mesh's mean error; 0: it has no reference
};

// The mean distance of the mesh's vertices from the surface, after the paths are aligned.
void ExpectSurface(const std::string& out, const std::string& sequence, double bound_m) {
    const auto mesh = ReadPly(out + "/mesh.ply");
    const auto reference = ReadPly(sequence + "/reference.ply");
    const auto truth = ReadTrajectory(sequence + "/groundtruth.txt");
    const auto path = ReadTrajectory(out + "/trajectory.txt");
    ASSERT_TRUE(mesh.ok() && reference.ok() && truth.ok() && path.ok());
    const auto alignment = AlignTrajectories(truth.value().poses, path.value().poses);
    ASSERT_TRUE(alignment.ok()) << alignment.message();
    MeshErrorOptions options;
    options.T_reference_mesh = alignment.value().T_reference_estimate;
    const auto error = MeasureMeshError(mesh.value(), reference.value(), options);
    ASSERT_TRUE(error.ok()) << error.message();
    EXPECT_LE(error.value().accuracy_m.mean, bound_m);
}

class HouseSequence : public Recorded, public testing::WithParamInterface<House> {};

TEST_P(HouseSequence, MeetsItsBoundAtFullAndAtAQuarterOfTheRate) {
    ASSERT_NO_FATAL_FAILURE(Need(GetParam().name));
    if (IsSkipped()) return;
    for (const std::int64_t stride : {1, 4}) {
        const RunSummary run = RunOn(sequence, folder / "out", stride);
        EXPECT_EQ(run.counts.tracked, run.counts.frames);
        ASSERT_TRUE(run.ate.has_value());
        EXPECT_LE(run.ate->error_m.rmse, GetParam().ate_m * (stride == 1 ? 1 : 2))
            << "stride " << stride;
        if (stride == 1 && GetParam().surface_m > 0)
            ExpectSurface(folder / "out", sequence, GetParam().surface_m);
    }
}

INSTANTIATE_TEST_SUITE_P(All, HouseSequence,
                         testing::Values(House{"house_desk", 0.003, 0.004},
                                         House{"house_floor", 0.001},
                                         House{"house_wall_plain", 0.002}),
                         [](const auto& test) { return std::string(test.param.name); });

TEST_F(Recorded, GeometryAloneIsDegenerateOnAFloorAndSaysSo) {
    ASSERT_NO_FATAL_FAILURE(Need("house_floor"));
    if (IsSkipped()) return;
    const RunSummary run = RunOn(sequence, folder / "out", 1, 0, -1, TrackingMethod::kSdfGeometric);
    EXPECT_GT(run.counts.degenerate, 20);
    ASSERT_TRUE(run.ate.has_value());
    EXPECT_GT(run.ate->error_m.rmse, 0.05);
}

// A gate on a share of the Hessian's trace used to refuse nearly all of these frames, and the map
// stayed frozen.
TEST_F(Recorded, TeddyIsFusedFromItsFirstFrameToItsLast) {
    ASSERT_NO_FATAL_FAILURE(Need("tum_fr3_teddy_200"));
    if (IsSkipped()) return;
    const RunSummary run = RunOn(sequence, folder / "out");
    EXPECT_EQ(run.counts.fused, run.counts.frames);
    ASSERT_TRUE(run.ate.has_value());
    EXPECT_LE(run.ate->error_m.rmse, 0.0085);
}

TEST_F(Recorded, ThreadsAndRunsDoNotChangeAByte) {
    ASSERT_NO_FATAL_FAILURE(Need("tum_fr1_rpy"));
    if (IsSkipped()) return;
    std::string trajectory, mesh;
    for (const int threads : {1, 4, 4}) {
        RunOn(sequence, folder / "out", 1, threads, 40);
        const std::string t = ReadAll(folder / "out/trajectory.txt"),
                          m = ReadAll(folder / "out/mesh.ply");
        ASSERT_FALSE(t.empty());
        if (!trajectory.empty()) {
            EXPECT_EQ(t, trajectory) << threads << " threads";
            EXPECT_TRUE(m == mesh) << threads << " threads";
        }
        trajectory = t;
        mesh = m;
    }
}

struct IcpCase {
    const char* name;
    TrackingMethod method;
    double ate_m;
};

class IcpSequence : public Recorded, public testing::WithParamInterface<IcpCase> {};

// [D18] section 3.2. InfiniTAM's best depth-only tracker reaches 36 mm on fr1_rpy. The bound is for
// the first 300 frames on ray-cast views. The run with drawn views must agree with them on 30
// frames: from frame 31 on the pose on fr1_rpy is undetermined for a while with icp-rgb, and any
// two runs differ there randomly by up to 20 mm. (Without OpenGL the ray caster replaces the
// rasteriser, so the comparison is trivial.)
TEST_P(IcpSequence, MeetsItsBoundFromEitherPrediction) {
    ASSERT_NO_FATAL_FAILURE(Need(GetParam().name));
    if (IsSkipped()) return;
    constexpr std::int64_t kFrames = 300, kDrawnFrames = 30;
    const auto run = [&](IcpTracker::Prediction prediction, std::int64_t count) {
        RunConfig config;
        config.check_camera = false;  // it sees more in more frames, and the images would differ
        config.pipeline.trackers.method = GetParam().method;
        config.pipeline.trackers.icp.prediction = prediction;
        const RunSummary summary = RunWith(config, sequence, folder / "out", {.count = count});
        EXPECT_EQ(summary.counts.tracked, summary.counts.frames);
        return summary;
    };
    const auto path = [&] {
        auto read = ReadTrajectory(folder / "out/trajectory.txt");
        EXPECT_TRUE(read.ok()) << read.message();
        return read.ok() ? read.value().poses : std::vector<StampedPose>{};
    };
    const RunSummary cast = run(IcpTracker::Prediction::kRayCast, kFrames);
    ASSERT_TRUE(cast.ate.has_value());
    EXPECT_LE(cast.ate->error_m.rmse, GetParam().ate_m);
    const std::vector<StampedPose> cast_path = path();
    run(IcpTracker::Prediction::kRaster, kDrawnFrames);
    const auto apart = EvaluateAte(path(), cast_path, {});
    ASSERT_TRUE(apart.ok()) << apart.message();
    EXPECT_LE(apart.value().error_m.median, 0.0005);
}

INSTANTIATE_TEST_SUITE_P(All, IcpSequence,
                         testing::Values(IcpCase{"tum_fr1_rpy", TrackingMethod::kIcp, 0.036},
                                         IcpCase{"tum_fr1_rpy", TrackingMethod::kIcpRgb, 0.025},
                                         IcpCase{"house_desk", TrackingMethod::kIcp, 0.006},
                                         IcpCase{"house_desk", TrackingMethod::kIcpRgb, 0.004},
                                         IcpCase{"house_wall_plain", TrackingMethod::kIcp, 0.006},
                                         IcpCase{"house_wall_plain", TrackingMethod::kIcpRgb,
                                                 0.004}),
                         [](const auto& test) {
                             return std::string(test.param.name) +
                                    (test.param.method == TrackingMethod::kIcp ? "_icp"
                                                                               : "_icp_rgb");
                         });

// Undetermined motions follow the prealignment, which uses the texture, so the floor is still
// mapped correctly.
TEST_F(Recorded, IcpOnAFloorIsDegenerateAndWithColourItIsHeld) {
    ASSERT_NO_FATAL_FAILURE(Need("house_floor"));
    if (IsSkipped()) return;
    const RunSummary icp = RunOn(sequence, folder / "out", 1, 0, 100, TrackingMethod::kIcp);
    EXPECT_GT(icp.counts.degenerate, 75);
    EXPECT_EQ(icp.counts.fused, icp.counts.frames);
    const RunSummary with_colour =
        RunOn(sequence, folder / "out", 1, 0, 100, TrackingMethod::kIcpRgb);
    EXPECT_EQ(with_colour.counts.fused, with_colour.counts.frames);
    EXPECT_EQ(with_colour.counts.degenerate, 0);
    ASSERT_TRUE(with_colour.ate.has_value());
    EXPECT_LE(with_colour.ate->error_m.rmse, 0.002);
}

// Upper bound on how far a motion moves points at a distance of 1 m.
double MotionSize(const Eigen::Isometry3d& T) {
    return T.translation().norm() + RotationAngle(T, Eigen::Isometry3d::Identity()) * 1.0;
}

// A switch must not make the path jump. From the frame before the switch to the frame of the switch
// the path may deviate from the true motion by less than the camera moves in one frame. (The
// estimates of the methods may differ by a centimetre.)
TEST_F(Recorded, SwitchingMethodsKeepsPoseAndMap) {
    ASSERT_NO_FATAL_FAILURE(Need("tum_fr1_rpy"));
    if (IsSkipped()) return;
    RunRequest request;
    request.source = sequence;
    request.output_folder = folder / "out";
    request.selection.count = 240;
    request.switches = {
        {60, TrackingMethod::kIcp}, {120, TrackingMethod::kSdf}, {180, TrackingMethod::kIcpRgb}};
    const std::atomic<bool> stop{false};
    const auto run = ExecuteRun(request, {}, {}, stop);
    ASSERT_TRUE(run.ok()) << run.message();
    EXPECT_EQ(run.value().counts.tracked, 240);
    ASSERT_TRUE(run.value().ate.has_value());
    EXPECT_LE(run.value().ate->error_m.rmse, 0.025);  // of icp, the worst of the three
    const auto truth = ReadTrajectory(sequence + "/groundtruth.txt");
    const auto path = ReadTrajectory(folder / "out/trajectory.txt");
    ASSERT_TRUE(truth.ok() && path.ok());
    // The size of the true motion, and the deviation of the path from it.
    const auto motion_at = [&](std::size_t i) -> std::pair<double, double> {
        const StampedPose &before = path.value().poses[i - 1], &after = path.value().poses[i];
        const auto true_before = InterpolatePose(truth.value().poses, before.stamp_s);
        const auto true_after = InterpolatePose(truth.value().poses, after.stamp_s);
        if (!true_before || !true_after) return {0, 0};
        const Eigen::Isometry3d moved = before.T_world_camera.inverse() * after.T_world_camera;
        const Eigen::Isometry3d truly_moved = true_before->inverse() * *true_after;
        return {MotionSize(truly_moved), MotionSize(truly_moved.inverse() * moved)};
    };
    for (const std::size_t at : {60u, 120u, 180u}) {
        double largest_motion_m = 0;
        for (std::size_t i = at - 10; i <= at + 10; ++i)
            largest_motion_m = std::max(largest_motion_m, motion_at(i).first);
        EXPECT_LT(motion_at(at).second, largest_motion_m) << "frame " << at;
    }
}

// [D18] Table 1 reports 4.3 mm and 0.08 degrees on noise-free synthetic frames. The bound here is 1
// mm.
TEST(Synthetic, NoiseFreeDeskIsTrackedToAMillimetre) {
    TempFolder folder;
    const RunSummary run = RunOn("synthetic:desk", folder / "out", 1, 0, 60);
    EXPECT_EQ(run.counts.tracked, 60);
    ASSERT_TRUE(run.ate.has_value());
    EXPECT_LE(run.ate->error_m.rmse, 0.001);
}

}  // namespace
}  // namespace tessera
