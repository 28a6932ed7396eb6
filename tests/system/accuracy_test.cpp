// Accuracy of the whole program on sequences with ground truth: default settings, every frame,
// SE(3) alignment without scale. The bounds are the project's requirements, not the current
// results, which are in docs/benchmarks/README.md.
#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <vector>

#include "eval/alignment.h"
#include "eval/mesh_error.h"
#include "io/mesh_io.h"
#include "io/trajectory.h"
#include "run/run.h"
#include "support/temp_folder.h"
#include "system/recorded.h"

namespace tessera {
namespace {

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

// Three frames per second. The camera turns by half of the view between two frames, most of all at
// the start: there it is lost at once, and the scan begins again. The frames before count as lost.
TEST_F(Recorded, Freiburg1RpyIsTrackedAtATenthOfItsRate) {
    ASSERT_NO_FATAL_FAILURE(Need("tum_fr1_rpy"));
    if (IsSkipped()) return;
    const RunSummary run = RunOn(sequence, folder / "out", 10);
    EXPECT_EQ(run.counts.frames, 72);
    EXPECT_EQ(run.counts.tracked + run.counts.lost, 72);
    EXPECT_GE(run.counts.fused, 50);
    ASSERT_TRUE(run.ate.has_value());
    EXPECT_LE(run.ate->error_m.rmse, 0.022);
}

// Two frames per second. Nearly each is found by appearance, and is to be fused at once: nobody
// gets from one room to another that fast.
TEST_F(Recorded, Freiburg1RpyIsFusedAtTwoFramesPerSecond) {
    ASSERT_NO_FATAL_FAILURE(Need("tum_fr1_rpy"));
    if (IsSkipped()) return;
    const RunSummary run =
        RunWith(RunConfig(), sequence, folder / "out", {.start = 450, .stride = 14});
    EXPECT_EQ(run.counts.frames, 19);
    EXPECT_GE(run.counts.fused, 13);
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
