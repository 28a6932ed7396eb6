// A complete run on a small synthetic sequence, and the files it leaves after success.
#include "run/run.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "io/mesh_io.h"
#include "io/trajectory.h"
#include "mapping/map_estimate.h"
#include "render/mesh_rasteriser.h"
#include "run/run_fixture.h"

namespace tessera {
namespace {

namespace fs = std::filesystem;

TEST_F(Run, GoesOnWithoutACameraAndSaysWhatItAssumes) {
    request.record_path = folder / "raw";
    ASSERT_TRUE(Execute().ok());
    fs::remove(folder / "raw/camera.yaml");
    request.record_path.clear();
    request.source = folder / "raw";
    warnings.clear();
    const auto run = Execute();
    ASSERT_TRUE(run.ok()) << run.message();
    EXPECT_EQ(run.value().counts.frames, 6);
    EXPECT_FALSE(run.value().source.camera_known);
    EXPECT_NEAR(run.value().source.camera.fx, 80 * std::sqrt(3.0), 1e-9);
    ASSERT_FALSE(warnings.empty());
    EXPECT_EQ(warnings.front(),
              "no camera.yaml, and the focal length cannot be estimated from this recording: "
              "assuming a field of view of 60 degrees, fx 138.6");
}

TEST_F(Run, BeginsWithTheRollingShutterThatTheRecordingShows) {
    config.synthetic.camera = {320, 240, 262.5, 262.5, 159.5, 119.5};
    config.synthetic.frames = 48;
    config.synthetic.speed = 4;
    config.synthetic.rig.colour_readout_s = 0.03;
    config.pipeline.map.voxel_size_m = 0.02;
    config.pipeline.map.truncation_m = 0.08;
    request.source = "synthetic:room";
    request.record_path = folder / "raw";
    ASSERT_TRUE(Execute().ok());
    request.record_path.clear();
    request.source = folder / "raw";
    const auto seen = Execute();
    config.check_camera = false;
    const auto unseen = Execute();
    ASSERT_TRUE(seen.ok() && seen.value().found.camera && unseen.ok());
    config.pipeline.trackers.photometric.shutter.readout_s =
        seen.value().found.camera->estimate.readout_s;
    const auto told = Execute();
    ASSERT_TRUE(told.ok() && told.value().ate && seen.value().ate && unseen.value().ate);
    EXPECT_NEAR(seen.value().found.camera->estimate.readout_s, 0.03, 0.004);
    EXPECT_NE(
        seen.value().source.notes.back().find("rolling shutter: read-out time of a colour image"),
        std::string::npos);
    EXPECT_EQ(seen.value().ate->error_m.rmse, told.value().ate->error_m.rmse);
    EXPECT_NE(seen.value().ate->error_m.rmse, unseen.value().ate->error_m.rmse);
}

TEST_F(Run, LeavesEveryFileOfTheContract) {
    const auto run = Execute();
    ASSERT_TRUE(run.ok()) << run.message();
    EXPECT_EQ(run.value().counts.frames, 6);
    const auto trajectory = ReadTrajectory(Out("trajectory.txt"));
    ASSERT_TRUE(trajectory.ok()) << trajectory.message();
    EXPECT_EQ(static_cast<std::int64_t>(trajectory.value().poses.size()),
              run.value().counts.tracked);
    const auto mesh = ReadPly(Out("mesh.ply"));
    ASSERT_TRUE(mesh.ok()) << mesh.message();
    EXPECT_GT(mesh.value().triangles.size(), 100u);
    EXPECT_EQ(mesh.value().colours.size(), mesh.value().vertices.size());
    EXPECT_GT(fs::file_size(Out("preview.png")), 1000u);
    EXPECT_EQ(Json("objects.json"), nlohmann::json::array());
    const std::string frames = ReadAll(Out("frames.csv"));
    EXPECT_EQ(std::count(frames.begin(), frames.end(), '\n'), 7);  // a header and six frames

    const auto timings = Json("timings.json");
    for (const char* key : {"frames", "tracked", "wall_s", "cpu_s", "fps", "peak_rss_mb"})
        EXPECT_TRUE(timings.at(key).is_number()) << key;
    for (const char* stage : {"frame", "decode", "track", "allocate", "fuse", "mesh"})
        for (const char* key : {"mean_ms", "median_ms", "p95_ms", "max_ms"})
            EXPECT_TRUE(timings.at("stages").at(stage).at(key).is_number()) << stage << " " << key;
    for (const char* key : {"blocks", "bytes", "bytes_per_voxel"})
        EXPECT_GT(timings.at("map").at(key), 0) << key;

    const auto json = Json("run.json");
    EXPECT_EQ(json.at("exit"), "finished");
    EXPECT_EQ(json.at("command_line").size(), 3u);
    EXPECT_EQ(json.at("configuration").at("mapping.voxel_size_m"), 0.04);
    EXPECT_EQ(json.at("configuration").at("tracking.method"), "sdf");
    EXPECT_EQ(json.at("source").at("kind"), run.value().source.kind);
    EXPECT_TRUE(json.at("ate").at("ate_rmse_m").is_number());
}

TEST_F(Run, RasterisingIsAStageOnlyIfItIsUsed) {
    if (const auto made = MeshRasteriser::Create({}); !made.ok()) GTEST_SKIP() << made.message();
    config.pipeline.trackers.method = TrackingMethod::kIcp;
    ASSERT_TRUE(Execute().ok());
    EXPECT_FALSE(Json("timings.json").at("stages").contains("rasterise"));
    config.pipeline.trackers.icp.prediction = IcpTracker::Prediction::kRaster;
    ASSERT_TRUE(Execute().ok());
    const auto stages = Json("timings.json").at("stages");
    EXPECT_GT(stages.at("rasterise").at("median_ms"), 0);
    EXPECT_LT(stages.at("rasterise").at("max_ms"), stages.at("track").at("max_ms"));
}

TEST_F(Run, TheSameBytesForAnyNumberOfThreads) {
    ASSERT_TRUE(Execute().ok());
    const std::string trajectory = ReadAll(Out("trajectory.txt")), mesh = ReadAll(Out("mesh.ply"));
    for (const int threads : {1, 2, 4}) {
        config.threads = threads;
        ASSERT_TRUE(Execute().ok());
        EXPECT_TRUE(ReadAll(Out("trajectory.txt")) == trajectory) << threads << " threads";
        EXPECT_TRUE(ReadAll(Out("mesh.ply")) == mesh) << threads << " threads";
    }
}

TEST_F(Run, StopsBetweenFramesWithEverythingWritten) {
    observer.on_frame = [this](const RunCounts& counts, std::int64_t total) {
        EXPECT_EQ(total, 6);
        stop = counts.frames == 2;
    };
    const auto run = Execute();
    ASSERT_TRUE(run.ok()) << run.message();
    EXPECT_EQ(run.value().counts.frames, 2);
    EXPECT_EQ(Json("run.json").at("exit"), "stopped");
    EXPECT_TRUE(fs::exists(Out("mesh.ply")));
}

TEST_F(Run, TheTrajectoryGrowsFrameByFrame) {
    std::vector<std::size_t> sizes;
    observer.on_frame = [&](const RunCounts&, std::int64_t) {
        sizes.push_back(fs::file_size(Out("trajectory.txt")));
        EXPECT_EQ(Json("run.json").at("exit"), "unfinished");
        EXPECT_FALSE(fs::exists(Out("mesh.ply")));  // not even one from an earlier run
    };
    fs::create_directories(request.output_folder);
    std::ofstream(Out("run.json")) << "{}";
    std::ofstream(Out("mesh.ply")) << "stale";
    ASSERT_TRUE(Execute().ok());
    ASSERT_EQ(sizes.size(), 6u);
    for (std::size_t i = 1; i < sizes.size(); ++i) EXPECT_GT(sizes[i], sizes[i - 1]);
}

TEST_F(Run, FusesAtGivenPosesOnly) {
    ASSERT_TRUE(Execute().ok());
    const auto tracked = ReadTrajectory(Out("trajectory.txt"));
    ASSERT_TRUE(tracked.ok());
    std::vector<StampedPose> poses(tracked.value().poses.begin(),
                                   tracked.value().poses.begin() + 4);
    for (StampedPose& pose : poses) pose.T_world_camera.pretranslate(Eigen::Vector3d(10, 0, 0));
    request.poses_file = folder / "poses.txt";
    ASSERT_TRUE(WriteTrajectory(request.poses_file, poses).ok());
    const auto run = Execute();
    ASSERT_TRUE(run.ok()) << run.message();
    EXPECT_EQ(run.value().counts.tracked, 4);
    EXPECT_EQ(run.value().counts.lost, 2);  // no pose near their time stamps
    EXPECT_NE(ReadAll(Out("frames.csv"))
                  .find(fmt::format("poses.txt has no pose near this time: its poses are from "
                                    "{:.3f} to {:.3f} s; this frame: {:.3f} s",
                                    poses.front().stamp_s, poses.back().stamp_s,
                                    tracked.value().poses.back().stamp_s)),
              std::string::npos);
    const auto given = ReadTrajectory(Out("trajectory.txt"));
    ASSERT_TRUE(given.ok());
    for (std::size_t i = 0; i < poses.size(); ++i)
        EXPECT_LT(
            (given.value().poses[i].T_world_camera.matrix() - poses[i].T_world_camera.matrix())
                .norm(),
            1e-6);
}

// The estimate of the map's memory against maps of a known surface.
TEST_F(Run, TheMapTakesAboutAsMuchMemoryAsEstimated) {
    for (const auto& [voxel_m, truncation_m] :
         {std::pair{0.04, 0.16}, {0.02, 0.08}, {0.02, 0.16}}) {
        SCOPED_TRACE(fmt::format("voxels of {} m, truncation {} m", voxel_m, truncation_m));
        config.pipeline.map.voxel_size_m = voxel_m;
        config.pipeline.map.truncation_m = truncation_m;
        const auto summary = ExecuteRun(request, config, observer, stop);
        ASSERT_TRUE(summary.ok()) << summary.message();
        const TriangleMesh mesh = ReadPly(folder / "out/mesh.ply").value();
        double area_m2 = 0;
        for (const auto& [a, b, c] : mesh.triangles) {
            const Eigen::Vector3f u = mesh.vertices[b] - mesh.vertices[a];
            area_m2 += 0.5 * u.cross(mesh.vertices[c] - mesh.vertices[a]).norm();
        }
        const double ratio = static_cast<double>(summary.value().map.bytes) /
                             (area_m2 * MapBytesPerSquareMetre(voxel_m, truncation_m));
        EXPECT_GT(ratio, 1 / 1.5);
        EXPECT_LT(ratio, 1.5);
        RecordProperty("ratio", std::to_string(ratio));
    }
}

TEST_F(Run, WithoutAFolderNothingIsWritten) {
    request.output_folder.clear();
    const auto run = Execute();
    ASSERT_TRUE(run.ok()) << run.message();
    EXPECT_TRUE(run.value().ate.has_value());
    EXPECT_TRUE(fs::is_empty(folder.path()));
}

}  // namespace
}  // namespace tessera
