// Base of tests with the OpenNI2 runtime and the test driver. Sets the driver's environment, opens
// the source and reads it.
#pragma once

#include <gtest/gtest.h>
#include <stdlib.h>

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "io/openni_source.h"
#include "openni/test_pattern.h"

namespace tessera {

class OpenniTest : public testing::Test {
  protected:
    // No timing dependence unless a test asks for it. No calibrations of the user.
    OpenniTest() {
        Set("PACE", "fast");
        setenv("XDG_CONFIG_HOME", "/nonexistent", 1);
    }

    // Must be called before the source is opened. Each test runs in its own process.
    static void Set(const std::string& name, const std::string& value) {
        setenv(("TESSERA_TEST_DEVICE_" + name).c_str(), value.c_str(), 1);
    }
    static void Set(const std::string& name, int value) { Set(name, std::to_string(value)); }

    static std::unique_ptr<FrameSource> Open(const std::string& name = "openni2:",
                                             const OpenniConfig& config = {}) {
        auto source = OpenOpenniSource(name, config);
        EXPECT_TRUE(source.ok()) << source.message();
        return source.ok() ? std::move(source.value()) : nullptr;
    }

    struct Log {
        std::vector<Frame> frames;
        std::vector<std::string> skips, messages;  // of kSkip; of kWait, if not empty
        bool ended = false;
        std::string Text() const {
            std::string text;
            for (const auto& message : messages) text += message + "\n";
            return text;
        }
    };
    // Reads until there are `frames` frames, the source ends, or `most_results` results have been
    // returned.
    static Log ReadFrames(FrameSource& source, std::size_t frames, int most_results = 1000) {
        Log log;
        Frame frame;
        for (int i = 0; i < most_results && log.frames.size() < frames && !log.ended; ++i) {
            const ReadResult read = source.Read(frame);
            if (read.status == ReadStatus::kOk) log.frames.push_back(frame);
            if (read.status == ReadStatus::kSkip) log.skips.push_back(read.message);
            if (read.status == ReadStatus::kWait && !read.message.empty())
                log.messages.push_back(read.message);
            log.ended = read.status == ReadStatus::kEnd;
            EXPECT_NE(read.status, ReadStatus::kError) << read.message;
        }
        return log;
    }

    // The driver's number of the pattern in this frame, computed from its stamp (30 Hz).
    static int NumberOf(const Frame& frame, double first_stamp_s = 1) {
        return static_cast<int>(std::lround(30 * (frame.stamp_s - first_stamp_s)));
    }
    static Image<std::uint16_t> Millimetres(const Frame& frame) {
        Image<std::uint16_t> depth(frame.depth_m.width(), frame.depth_m.height());
        for (std::size_t i = 0; i < depth.size(); ++i)
            depth.data()[i] =
                static_cast<std::uint16_t>(std::lround(1000.0 * frame.depth_m.data()[i]));
        return depth;
    }
    static Image<std::uint16_t> ExpectedDepth(int number, int divisor = 1) {
        Image<std::uint16_t> depth(test_device::kWidth / divisor, test_device::kHeight / divisor);
        for (int y = 0; y < depth.height(); ++y)
            for (int x = 0; x < depth.width(); ++x)
                depth(x, y) = test_device::PatternDepth(number, divisor * x, divisor * y);
        return depth;
    }
    static ColourImage ExpectedColour(int number) {
        using test_device::PatternColour;
        ColourImage colour(test_device::kWidth, test_device::kHeight);
        for (int y = 0; y < colour.height(); ++y)
            for (int x = 0; x < colour.width(); ++x)
                colour(x, y) = {PatternColour(number, x, y, 0), PatternColour(number, x, y, 1),
                                PatternColour(number, x, y, 2)};
        return colour;
    }
    static void ExpectIncreasingStamps(const std::vector<Frame>& frames) {
        for (std::size_t i = 1; i < frames.size(); ++i) {
            EXPECT_GT(frames[i].stamp_s, frames[i - 1].stamp_s) << i;
            EXPECT_GT(frames[i].colour_stamp_s, frames[i - 1].colour_stamp_s) << i;
            EXPECT_EQ(frames[i].index, frames[i - 1].index + 1);
        }
    }
};

}  // namespace tessera
