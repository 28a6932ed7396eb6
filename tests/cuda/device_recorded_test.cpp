#include "cuda/device_pipeline.h"
#include "cuda/recorded_run.h"

namespace tessera::host {
namespace {

class DeviceRecorded : public testing::TestWithParam<TrackingMethod> {};

TEST_P(DeviceRecorded, IsTheProcessorsRun) {
    if (!std::filesystem::exists(testing_support::RecordingFolder()))
        GTEST_SKIP() << testing_support::HowToGetTheRecording();
    DevicePipeline device("host", std::size_t{4} << 30);
    testing_support::ExpectTheProcessorsRun(GetParam(), device);
}

INSTANTIATE_TEST_SUITE_P(Methods, DeviceRecorded,
                         testing::Values(TrackingMethod::kSdf, TrackingMethod::kIcpRgb),
                         [](const auto& test) { return test.index == 0 ? "Sdf" : "IcpRgb"; });

}  // namespace
}  // namespace tessera::host
