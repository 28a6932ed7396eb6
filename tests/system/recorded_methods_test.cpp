// Recorded sequences again: motions that a scene leaves open, any number of threads, and switches
// of the method.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <fstream>
#include <sstream>
#include <string>
#include <utility>

#include "io/trajectory.h"
#include "run/run.h"
#include "system/recorded.h"

namespace tessera {
namespace {

std::string ReadAll(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    std::stringstream text;
    text << file.rdbuf();
    return text.str();
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

}  // namespace
}  // namespace tessera
