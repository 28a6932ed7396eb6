// Whole runs on a camera, with what goes wrong in them.
#include <atomic>
#include <chrono>

#include "io/openni_devices.h"
#include "openni/openni_fixture.h"
#include "system/run.h"

namespace tessera {
namespace {

class OpenniRun : public OpenniTest {
  protected:
    OpenniRun() {
        Set("SMALL", 1);
        request_.source = "openni2:";
        observer_.on_warning = [this](const std::string& text) { warnings_ += text + "\n"; };
    }

    RunRequest request_;
    RunObserver observer_;
    std::string warnings_;
    std::atomic<bool> stop_{false};
};

TEST_F(OpenniRun, WaitingCountsAsNoFrameAndIsTold) {
    Set("VANISH_AT", 3);
    Set("BACK_MS", 100);
    request_.selection.count = 6;
    const auto summary = ExecuteRun(request_, {}, observer_, stop_);
    ASSERT_TRUE(summary.ok()) << summary.message();
    EXPECT_EQ(summary.value().counts.frames, 6);
    EXPECT_EQ(summary.value().counts.skipped, 0);
    EXPECT_NE(warnings_.find("camera unplugged, waiting for it\n"), std::string::npos) << warnings_;
    EXPECT_NE(warnings_.find("camera is back\n"), std::string::npos) << warnings_;
}

TEST_F(OpenniRun, StopsSoonWhileThereIsNoCamera) {
    Set("VANISH_AT", 2);
    std::chrono::steady_clock::time_point asked;
    observer_.on_warning = [&](const std::string& text) {
        if (text.find("unplugged") == std::string::npos) return;
        asked = std::chrono::steady_clock::now();
        stop_ = true;
    };
    const auto summary = ExecuteRun(request_, {}, observer_, stop_);
    ASSERT_TRUE(summary.ok()) << summary.message();
    EXPECT_TRUE(summary.value().stopped);
    EXPECT_EQ(summary.value().counts.frames, 2);
    EXPECT_LT(std::chrono::duration<double>(std::chrono::steady_clock::now() - asked).count(), 1.5);
}

TEST_F(OpenniRun, TheListingNamesTheDevices) {
    Set("COUNT", 2);
    const OpenniListing listing = ListOpenniDevices();
    ASSERT_EQ(listing.devices.size(), 2u);
    EXPECT_EQ(listing.devices[1].uri, "test://1");
    EXPECT_EQ(listing.devices[1].vendor, "Tessera");
    EXPECT_EQ(listing.devices[1].name, "Test camera");
    EXPECT_TRUE(listing.advice.empty());
    EXPECT_NE(listing.driver_folder.find("tests/openni/runtime/OpenNI2/Drivers"), std::string::npos) << listing.driver_folder;
}

TEST_F(OpenniRun, WithoutADeviceThereIsAdvice) {
    Set("COUNT", 0);
    const OpenniListing listing = ListOpenniDevices();
    EXPECT_TRUE(listing.built_in);
    EXPECT_TRUE(listing.version.starts_with("2.")) << listing.version;
    EXPECT_TRUE(listing.devices.empty());
    EXPECT_FALSE(listing.advice.empty());
}

}  // namespace
}  // namespace tessera
