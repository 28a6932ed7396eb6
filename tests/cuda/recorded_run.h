// A full-size recording on a device gives the results of the CPU, byte for byte.
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "run/run.h"
#include "support/temp_folder.h"

namespace tessera::testing_support {

// The expected location of TUM's fr1 rpy.
inline std::string RecordingFolder() {
    const char* data = std::getenv("TESSERA_DATA");
    return (data != nullptr ? data : std::string(TESSERA_SOURCE_DIR) + "/../shared/data") +
           "/tum_fr1_rpy";
}

inline std::string HowToGetTheRecording() {
    return RecordingFolder() +
           " is absent: set TESSERA_DATA to a folder that holds TUM's fr1 rpy under the name "
           "tum_fr1_rpy";
}

// Number of frames. TESSERA_DEVICE_FRAMES overrides the small default; -1 means all.
inline std::int64_t RecordedFrames() {
    const char* frames = std::getenv("TESSERA_DEVICE_FRAMES");
    return frames != nullptr ? std::atoll(frames) : 12;
}

// The trajectory and the mesh written by a run on the recording. A null `device` means the CPU.
inline std::array<std::string, 2> RecordedRun(TrackingMethod method, Backend* device) {
    const TempFolder folder;
    RunRequest request;
    request.source = RecordingFolder();
    request.output_folder = folder.path();
    request.selection.count = RecordedFrames();
    request.device = device;
    RunConfig config;
    config.pipeline.trackers.method = method;
    const std::atomic<bool> stop{false};
    const auto run = ExecuteRun(request, config, {}, stop);
    EXPECT_TRUE(run.ok()) << run.message();
    if (run.ok()) {
        EXPECT_GT(run.value().counts.tracked, 10);
    }
    std::array<std::string, 2> results;
    for (std::size_t i = 0; i < results.size(); ++i) {
        std::ifstream file(folder / (i == 0 ? "trajectory.txt" : "mesh.ply"), std::ios::binary);
        std::stringstream content;
        content << file.rdbuf();
        results[i] = content.str();
        EXPECT_FALSE(results[i].empty());
    }
    return results;
}

inline void ExpectTheProcessorsRun(TrackingMethod method, Backend& device) {
    const auto expected = RecordedRun(method, nullptr), results = RecordedRun(method, &device);
    EXPECT_TRUE(results[0] == expected[0]) << "the trajectories differ";
    EXPECT_TRUE(results[1] == expected[1]) << "the meshes differ";
}

}  // namespace tessera::testing_support
