// Complete runs on a camera, with faults.
#include <atomic>
#include <chrono>

#include "io/openni_devices.h"
#include "openni/openni_fixture.h"
#include "run/run.h"

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

// Camera faults in a live run at 30 frames per second: none of them ends the run. (The pattern is
// not a real scene, so tracking results mean nothing.)
class OpenniLive : public OpenniRun {
  protected:
    OpenniLive() {
        Set("PACE", "real");
        request_.live = true;
        request_.selection.count = 45;
    }
    RunSummary Run() {
        const auto summary = ExecuteRun(request_, {}, observer_, stop_);
        EXPECT_TRUE(summary.ok()) << summary.message();
        return summary.ok() ? summary.value() : RunSummary{};
    }
};

TEST_F(OpenniLive, VanishesInMidScanAndComesBack) {
    Set("VANISH_AT", 20);
    Set("BACK_MS", 300);
    const RunSummary run = Run();
    EXPECT_EQ(run.counts.frames, 45);
    EXPECT_GT(run.map.blocks, 10);
    EXPECT_NE(warnings_.find("camera is back\n"), std::string::npos) << warnings_;
}

TEST_F(OpenniLive, TheStreamsStallForTwoSeconds) {
    Set("STALL_AT", 20);
    Set("STALL_MS", 2000);
    const RunSummary run = Run();
    EXPECT_EQ(run.counts.frames, 45);
    EXPECT_NE(warnings_.find("no images for "), std::string::npos) << warnings_;
}

TEST_F(OpenniLive, ColourAtHalfTheRate) {
    Set("COLOUR_EVERY", 2);
    request_.selection.count = 20;
    const RunSummary run = Run();
    EXPECT_EQ(run.counts.frames, 20);
}

TEST_F(OpenniLive, FivePercentGarbage) {
    Set("GARBAGE", 5);
    const RunSummary run = Run();
    EXPECT_EQ(run.counts.frames, 45);
    EXPECT_GT(run.map.blocks, 10);
}

TEST_F(OpenniRun, TheListingNamesTheDevices) {
    Set("COUNT", 2);
    const OpenniListing listing = ListOpenniDevices();
    ASSERT_EQ(listing.devices.size(), 2u);
    EXPECT_EQ(listing.devices[1].uri, "test://1");
    EXPECT_EQ(listing.devices[1].vendor, "Tessera");
    EXPECT_EQ(listing.devices[1].name, "Test camera");
    EXPECT_TRUE(listing.advice.empty());
    EXPECT_NE(listing.driver_folder.find("tests/openni/runtime/OpenNI2/Drivers"), std::string::npos)
        << listing.driver_folder;
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
