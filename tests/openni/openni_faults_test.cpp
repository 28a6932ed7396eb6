// Tests of camera faults during a scan.
#include <chrono>

#include "openni/openni_fixture.h"

namespace tessera {
namespace {

using OpenniFaults = OpenniTest;

double Seconds(const std::function<void()>& action) {
    const auto begin = std::chrono::steady_clock::now();
    action();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

TEST_F(OpenniFaults, ACameraThatIsUnpluggedAndComesBack) {
    Set("VANISH_AT", 5);
    Set("BACK_MS", 300);
    const auto source = Open();
    ASSERT_NE(source, nullptr);
    const Log log = ReadFrames(*source, 12);
    ASSERT_EQ(log.frames.size(), 12u);
    EXPECT_EQ(log.messages,
              (std::vector<std::string>{"camera unplugged, waiting for it", "camera is back"}));
    ExpectIncreasingStamps(log.frames);
    EXPECT_GT(log.frames[5].stamp_s - log.frames[4].stamp_s, 0.29);  // the time the camera was away
    EXPECT_LT(log.frames[5].stamp_s - log.frames[4].stamp_s, 2.0);
    EXPECT_NEAR(log.frames[11].stamp_s - log.frames[5].stamp_s, 6 / 30.0, 1e-5);
    // The driver's frame 5 was lost when the camera was unplugged.
    EXPECT_EQ(Millimetres(log.frames[5]), ExpectedDepth(6));
}

TEST_F(OpenniFaults, ANamedCameraIsWaitedForUnderItsName) {
    Set("COUNT", 2);
    Set("VANISH_AT", 2);
    const auto source = Open("openni2:test://1");
    ASSERT_NE(source, nullptr);
    const Log log = ReadFrames(*source, 5, 8);  // the other camera is not used instead
    EXPECT_EQ(log.frames.size(), 2u);
    EXPECT_EQ(log.messages,
              std::vector<std::string>{"openni2:test://1: camera unplugged, waiting for it"});
}

TEST_F(OpenniFaults, EachReadReturnsInTimeWhileThereIsNoCamera) {
    Set("VANISH_AT", 1);
    const auto source = Open();
    ASSERT_NE(source, nullptr);
    ASSERT_EQ(ReadFrames(*source, 1).frames.size(), 1u);
    Frame frame;
    for (int i = 0; i < 4; ++i)
        EXPECT_LT(Seconds([&] { EXPECT_EQ(source->Read(frame).status, ReadStatus::kWait); }), 0.5);
}

TEST_F(OpenniFaults, ACameraThatFallsSilentIsToldOnce) {
    Set("STALL_AT", 3);
    Set("STALL_MS", 1500);
    const auto source = Open();
    ASSERT_NE(source, nullptr);
    EXPECT_LT(Seconds([&] {
                  const Log log = ReadFrames(*source, 6);
                  ASSERT_EQ(log.frames.size(), 6u);
                  ASSERT_EQ(log.messages.size(), 1u) << log.Text();
                  EXPECT_TRUE(log.messages[0].starts_with("no images for 1.")) << log.messages[0];
                  ExpectIncreasingStamps(log.frames);
              }),
              4);
}

TEST_F(OpenniFaults, EachReadReturnsInTimeWhileTheCameraIsSilent) {
    Set("DROP", 100);
    const auto source = Open();
    ASSERT_NE(source, nullptr);
    Frame frame;
    for (int i = 0; i < 4; ++i)
        EXPECT_LT(Seconds([&] { EXPECT_EQ(source->Read(frame).status, ReadStatus::kWait); }), 0.5);
}

TEST_F(OpenniFaults, AStreamThatIsMissingIsNamed) {
    Set("COLOUR_EVERY", 1000000);  // a single colour image
    Set("PACE", "real");
    const auto source = Open();
    ASSERT_NE(source, nullptr);
    const Log log = ReadFrames(*source, 2, 6);
    EXPECT_EQ(log.frames.size(), 1u);
    ASSERT_EQ(log.messages.size(), 2u) << log.Text();
    EXPECT_NE(log.messages[0].find("depth images had no colour image within 20 ms"),
              std::string::npos)
        << log.Text();
    EXPECT_TRUE(log.messages[1].starts_with("no colour images for 1.")) << log.Text();
}

TEST_F(OpenniFaults, DifferentRatesCostTheImagesWithoutPartner) {
    Set("COLOUR_EVERY", 2);
    const auto source = Open();
    ASSERT_NE(source, nullptr);
    const Log log = ReadFrames(*source, 30);
    ASSERT_EQ(log.frames.size(), 30u);
    ExpectIncreasingStamps(log.frames);
    for (const Frame& frame : log.frames) {
        EXPECT_EQ(NumberOf(frame) % 2, 0);
        EXPECT_EQ(Millimetres(frame), ExpectedDepth(NumberOf(frame)));
        EXPECT_EQ(frame.colour, ExpectedColour(NumberOf(frame)));
    }
    ASSERT_EQ(log.messages.size(), 1u);
    EXPECT_EQ(log.messages[0].find("10 of the first 2"), 0u) << log.messages[0];
}

TEST_F(OpenniFaults, StampsMayDifferByLessThanTheGap) {
    Set("COLOUR_DELAY_US", 12000);
    const auto source = Open();
    ASSERT_NE(source, nullptr);
    const Log log = ReadFrames(*source, 10);
    ASSERT_EQ(log.frames.size(), 10u);
    for (const Frame& frame : log.frames) {
        EXPECT_NEAR(frame.colour_stamp_s - frame.stamp_s, 0.012, 1e-9);
        EXPECT_EQ(frame.colour, ExpectedColour(NumberOf(frame)));
    }
}

TEST_F(OpenniFaults, GarbageIsSkippedWithAReason) {
    Set("GARBAGE", 5);
    const auto source = Open();
    ASSERT_NE(source, nullptr);
    const Log log = ReadFrames(*source, 150);
    ASSERT_EQ(log.frames.size(), 150u);
    ExpectIncreasingStamps(log.frames);
    int noise = 0;
    for (const Frame& frame : log.frames) {
        ASSERT_EQ(frame.depth_m.width(), 640);
        ASSERT_EQ(frame.colour.height(), 480);
        ASSERT_LT(frame.stamp_s, 10);
        noise += Millimetres(frame) != ExpectedDepth(NumberOf(frame));
    }
    EXPECT_LT(noise, 8);  // the source does not check depth values
    EXPECT_GT(log.skips.size(), 5u);
    std::string all;
    for (const std::string& why : log.skips) all += why + "\n";
    for (const char* kind : {"320 x 240 pixels instead of 640 x 480", "it is empty",
                             "is not later than", "is implausible"})
        EXPECT_NE(all.find(kind), std::string::npos) << kind << " in\n" << all;
}

}  // namespace
}  // namespace tessera
