// Runs on recorded sequences with ground truth.
#pragma once

#include <gtest/gtest.h>

#include <atomic>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <string>

#include "run/run.h"
#include "support/temp_folder.h"

namespace tessera {

inline std::string DataFolder(const std::string& name) {
    const char* data = std::getenv("TESSERA_DATA");
    return (data != nullptr ? std::string(data)
                            : std::string(TESSERA_SOURCE_DIR) + "/../shared/data") +
           "/" + name;
}

inline RunSummary RunWith(const RunConfig& config, const std::string& source,
                          const std::string& out, const FrameSelection& selection = {}) {
    RunRequest request;
    request.source = source;
    request.output_folder = out;
    request.selection = selection;
    const std::atomic<bool> stop{false};
    const auto run = ExecuteRun(request, config, {}, stop);
    EXPECT_TRUE(run.ok()) << run.message();
    return run.ok() ? run.value() : RunSummary{};
}

inline RunSummary RunOn(const std::string& source, const std::string& out, std::int64_t stride = 1,
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
        if (!std::filesystem::exists(sequence))
            GTEST_SKIP() << sequence << " is absent: set TESSERA_DATA to a folder that holds "
                         << name
                         << " (TUM RGB-D sequences: cvg.cit.tum.de/data/datasets/rgbd-dataset)";
    }
    TempFolder folder;
    std::string sequence;
};

}  // namespace tessera
