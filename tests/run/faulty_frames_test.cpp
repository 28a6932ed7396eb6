// Frames with the faults of cables, drivers and cameras among good ones: none of them ends a run or
// loses the camera. TESSERA_FAULTY_FRAMES sets the number of frames (default 600).
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <map>
#include <sstream>

#include "eval/ate.h"
#include "io/trajectory.h"
#include "run/run.h"
#include "support/temp_folder.h"
#include "synth/synthetic_source.h"

namespace tessera {
namespace {

constexpr int kMostLost = 5;            // good frames in a row
constexpr double kMostError_m = 0.015;  // RMSE over the good frames; 0.007 without faults
constexpr double kSlowly = 0.3;         // a hand-held camera at 3 cm voxels

RunConfig FaultyRoom(double share, int seed) {
    const char* frames = std::getenv("TESSERA_FAULTY_FRAMES");
    RunConfig config;
    config.synthetic.camera = {160, 120, 131, 131, 79.5, 59.5};
    config.synthetic.sensor.noise = NoiseModel::kKinect;
    config.synthetic.speed = kSlowly;
    config.synthetic.seed = seed;
    config.synthetic.frames = frames != nullptr ? std::atoi(frames) : 600;
    config.synthetic.faults.share = share;
    config.pipeline.map = {.voxel_size_m = 0.03, .truncation_m = 0.12};
    return config;
}

class FaultyFrames : public testing::TestWithParam<int> {};
// With seed 2, two faults in a row move the camera to a wrong pose, from which the right one is
// farther than a camera moves in a frame.
INSTANTIATE_TEST_SUITE_P(Seeds, FaultyFrames, testing::Values(1, 2));

TEST_P(FaultyFrames, NeverLoseTheCamera) {
    const TempFolder folder;
    const RunConfig config = FaultyRoom(0.2, GetParam());
    RunRequest request;
    request.source = "synthetic:room";
    request.output_folder = folder / "out";
    const auto run = ExecuteRun(request, config, {}, {});
    ASSERT_TRUE(run.ok()) << run.message();
    ASSERT_EQ(run.value().counts.frames, config.synthetic.frames);

    const FrameFaults faults(config.synthetic.faults, config.synthetic.camera,
                             static_cast<std::uint64_t>(config.synthetic.seed));
    std::map<FrameFault, int> seen;
    std::ifstream table(folder / "out/frames.csv");
    std::string line;
    std::getline(table, line);
    int lost = 0, longest = 0;
    while (std::getline(table, line)) {
        std::istringstream cells(line);
        std::string index, stamp, method, status;
        for (std::string* cell : {&index, &stamp, &method, &status})
            std::getline(cells, *cell, ',');
        if (const auto fault = faults.Of(std::stoll(index))) {
            ++seen[*fault];
            continue;
        }
        lost = status == "lost" ? lost + 1 : 0;
        longest = std::max(longest, lost);
    }
    EXPECT_LE(longest, kMostLost);
    // Those with a time stamp in the past are skipped, and are not in the table.
    EXPECT_EQ(std::ssize(seen), kFrameFaults - 1);
    EXPECT_GT(run.value().counts.skipped, 0);

    const auto source = OpenSynthetic("room", config.synthetic);
    ASSERT_TRUE(source.ok());
    std::vector<StampedPose> truth, good;
    Frame frame;
    RenderedView view;
    for (int i = 0; i < config.synthetic.frames; ++i) {
        ASSERT_EQ(source.value()->ReadWithTruth(frame, view).status, ReadStatus::kOk);
        if (!faults.Of(i)) truth.push_back({frame.stamp_s, *frame.T_world_camera});
    }
    const auto path = ReadTrajectory(folder / "out/trajectory.txt");
    ASSERT_TRUE(path.ok()) << path.message();
    for (const StampedPose& pose : path.value().poses)
        if (std::ranges::any_of(truth, [&](const StampedPose& t) {
                return std::abs(t.stamp_s - pose.stamp_s) < 1e-3;
            }))
            good.push_back(pose);
    const auto ate = EvaluateAte(truth, good);
    ASSERT_TRUE(ate.ok()) << ate.message();
    EXPECT_LE(ate.value().error_m.rmse, kMostError_m);
    EXPECT_GE(std::ssize(ate.value().pairs), std::ssize(truth) - 2 * kMostLost);
}

}  // namespace
}  // namespace tessera
