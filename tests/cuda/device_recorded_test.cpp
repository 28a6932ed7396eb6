// A recording at full size on the serial device: the processor's results, byte for byte.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "cuda/device_pipeline.h"
#include "support/temp_folder.h"
#include "system/run.h"

namespace tessera::serial {
namespace {

constexpr std::size_t kPlenty = std::size_t{4} << 30;

// More frames than the few that are tried each time: TESSERA_DEVICE_FRAMES.
std::int64_t FrameCount() {
    const char* frames = std::getenv("TESSERA_DEVICE_FRAMES");
    return frames != nullptr ? std::atoll(frames) : 12;
}

std::string ReadAll(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    std::stringstream text;
    text << file.rdbuf();
    return text.str();
}

class DeviceRecorded : public testing::TestWithParam<TrackingMethod> {
  protected:
    void RunInto(const std::string& folder, const std::string& source, Device* device) {
        RunRequest request;
        request.source = source;
        request.output_folder = folder;
        request.selection.count = FrameCount();
        request.device = device;
        RunConfig config;
        config.pipeline.trackers.method = GetParam();
        const std::atomic<bool> stop{false};
        const auto run = ExecuteRun(request, config, {}, stop);
        ASSERT_TRUE(run.ok()) << run.message();
        EXPECT_GT(run.value().counts.tracked, 10);
    }
};

TEST_P(DeviceRecorded, IsTheProcessorsRun) {
    const char* data = std::getenv("TESSERA_DATA");
    const std::string source = (data != nullptr ? data : std::string(TESSERA_SOURCE_DIR) + "/../shared/data") + "/tum_fr1_rpy";
    if (!std::filesystem::exists(source))
        GTEST_SKIP() << source << " is absent: set TESSERA_DATA to a folder that holds TUM's fr1 rpy under that name";
    const TempFolder folder;
    RunInto(folder / "processor", source, nullptr);
    DevicePipeline device("serial", kPlenty);
    RunInto(folder / "device", source, &device);
    for (const char* file : {"/trajectory.txt", "/mesh.ply"}) {
        const std::string expected = ReadAll(folder / ("processor" + std::string(file)));
        EXPECT_FALSE(expected.empty()) << file;
        EXPECT_TRUE(ReadAll(folder / ("device" + std::string(file))) == expected) << file;
    }
}

INSTANTIATE_TEST_SUITE_P(Methods, DeviceRecorded, testing::Values(TrackingMethod::kSdf, TrackingMethod::kIcpRgb),
                         [](const auto& test) { return test.index == 0 ? "Sdf" : "IcpRgb"; });

}  // namespace
}  // namespace tessera::serial
