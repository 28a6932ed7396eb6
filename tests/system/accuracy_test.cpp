// The whole program's figures on sequences with ground truth: the defaults, every frame, SE(3) alignment without scale.
// The bounds are the project's, not the present figures: docs/benchmarks.md has those.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "eval/alignment.h"
#include "eval/mesh_error.h"
#include "io/mesh_io.h"
#include "io/trajectory.h"
#include "support/temp_folder.h"
#include "system/run.h"

namespace tessera {
namespace {

namespace fs = std::filesystem;

std::string DataFolder(const std::string& name) {
    const char* data = std::getenv("TESSERA_DATA");
    return (data != nullptr ? std::string(data) : std::string(TESSERA_SOURCE_DIR) + "/../shared/data") + "/" + name;
}

std::string ReadAll(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    std::stringstream text;
    text << file.rdbuf();
    return text.str();
}

RunSummary RunOn(const std::string& source, const std::string& out, std::int64_t stride = 1, int threads = 0,
                 std::int64_t count = -1, TrackingMethod method = TrackingMethod::kSdf) {
    RunRequest request;
    request.source = source;
    request.output_folder = out;
    request.selection.stride = stride;
    request.selection.count = count;
    RunConfig config;
    config.threads = threads;
    config.pipeline.trackers.method = method;
    const std::atomic<bool> stop{false};
    const auto run = ExecuteRun(request, config, {}, stop);
    EXPECT_TRUE(run.ok()) << run.message();
    return run.ok() ? run.value() : RunSummary{};
}

class Recorded : public testing::Test {
  protected:
    // The sequence's folder; skips the test where it is absent.
    void Need(const std::string& name) {
        sequence = DataFolder(name);
        if (!fs::exists(sequence))
            GTEST_SKIP() << sequence << " is absent: set TESSERA_DATA to a folder that holds " << name
                         << " (TUM RGB-D sequences: cvg.cit.tum.de/data/datasets/rgbd-dataset)";
    }
    TempFolder folder;
    std::string sequence;
};

TEST_F(Recorded, Freiburg1RpyIsTrackedToTwoCentimetres) {
    ASSERT_NO_FATAL_FAILURE(Need("tum_fr1_rpy"));
    if (IsSkipped()) return;
    const RunSummary run = RunOn(sequence, folder / "out");
    EXPECT_EQ(run.counts.frames, 694);
    EXPECT_EQ(run.counts.tracked, 694);
    ASSERT_TRUE(run.ate.has_value());
    EXPECT_LE(run.ate->error_m.rmse, 0.022);
    EXPECT_LE(run.map.bytes_per_voxel, 12.0);
}

struct House {
    const char* name;
    double ate_m;
};

class HouseSequence : public Recorded, public testing::WithParamInterface<House> {};

TEST_P(HouseSequence, MeetsItsBoundAtFullAndAtAQuarterOfTheRate) {
    ASSERT_NO_FATAL_FAILURE(Need(GetParam().name));
    if (IsSkipped()) return;
    for (const std::int64_t stride : {1, 4}) {
        const RunSummary run = RunOn(sequence, folder / "out", stride);
        EXPECT_EQ(run.counts.tracked, run.counts.frames);
        ASSERT_TRUE(run.ate.has_value());
        EXPECT_LE(run.ate->error_m.rmse, GetParam().ate_m * (stride == 1 ? 1 : 2)) << "stride " << stride;
    }
}

INSTANTIATE_TEST_SUITE_P(All, HouseSequence,
                         testing::Values(House{"house_desk", 0.003}, House{"house_floor", 0.001},
                                         House{"house_wall_plain", 0.002}),
                         [](const auto& test) { return std::string(test.param.name); });

TEST_F(Recorded, HouseDeskSurface) {
    ASSERT_NO_FATAL_FAILURE(Need("house_desk"));
    if (IsSkipped()) return;
    RunOn(sequence, folder / "out");
    const auto mesh = ReadPly(folder / "out/mesh.ply");
    const auto reference = ReadPly(sequence + "/reference.ply");
    const auto truth = ReadTrajectory(sequence + "/groundtruth.txt");
    const auto path = ReadTrajectory(folder / "out/trajectory.txt");
    ASSERT_TRUE(mesh.ok() && reference.ok() && truth.ok() && path.ok());
    const auto alignment = AlignTrajectories(truth.value().poses, path.value().poses);
    ASSERT_TRUE(alignment.ok()) << alignment.message();
    MeshErrorOptions options;
    options.T_reference_mesh = alignment.value().T_reference_estimate;
    const auto error = MeasureMeshError(mesh.value(), reference.value(), options);
    ASSERT_TRUE(error.ok()) << error.message();
    EXPECT_LE(error.value().accuracy_m.mean, 0.004);
}

TEST_F(Recorded, GeometryAloneIsDegenerateOnAFloorAndSaysSo) {
    ASSERT_NO_FATAL_FAILURE(Need("house_floor"));
    if (IsSkipped()) return;
    const RunSummary run = RunOn(sequence, folder / "out", 1, 0, -1, TrackingMethod::kSdfGeometric);
    EXPECT_GT(run.counts.degenerate, 20);
    ASSERT_TRUE(run.ate.has_value());
    EXPECT_GT(run.ate->error_m.rmse, 0.05);
}

TEST_F(Recorded, ThreadsAndRunsDoNotChangeAByte) {
    ASSERT_NO_FATAL_FAILURE(Need("tum_fr1_rpy"));
    if (IsSkipped()) return;
    std::string trajectory, mesh;
    for (const int threads : {1, 2, 4, 2}) {
        RunOn(sequence, folder / "out", 1, threads, 60);
        const std::string t = ReadAll(folder / "out/trajectory.txt"), m = ReadAll(folder / "out/mesh.ply");
        ASSERT_FALSE(t.empty());
        if (!trajectory.empty()) {
            EXPECT_EQ(t, trajectory) << threads << " threads";
            EXPECT_TRUE(m == mesh) << threads << " threads";
        }
        trajectory = t;
        mesh = m;
    }
}

// [D18] Table 1: 4.3 mm and 0.08 degrees on noise-free synthetic frames; here at most a millimetre.
TEST(Synthetic, NoiseFreeDeskIsTrackedToAMillimetre) {
    TempFolder folder;
    const RunSummary run = RunOn("synthetic:desk", folder / "out", 1, 0, 60);
    EXPECT_EQ(run.counts.tracked, 60);
    ASSERT_TRUE(run.ate.has_value());
    EXPECT_LE(run.ate->error_m.rmse, 0.001);
}

}  // namespace
}  // namespace tessera
