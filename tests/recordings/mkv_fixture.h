// For tests of Azure Kinect recordings: one file, and what should be in it.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "io/jpeg_decoder.h"
#include "recordings/k4a_device.h"
#include "recordings/mkv_recording.h"
#include "recordings/mkv_writer.h"

namespace tessera {

class MkvFixture : public ::testing::Test {
  protected:
    MkvFixture() { recipe.calibration = kK4aDevice; }
    void SetUp() override {
        if (!HaveFfmpeg()) GTEST_SKIP() << "install ffmpeg";
    }

    RecordingResult Open() { return OpenMkv(folder.Path("a.mkv")); }
    RecordingResult WriteAndOpen() {
        WriteMkv(folder, "a.mkv", recipe);
        return Open();
    }
    // Loads a pair that must be of these images.
    void ExpectPair(Recording& recording, std::size_t pair, int depth_index, int colour_index) {
        SCOPED_TRACE(pair);
        const Status status = recording.Load(pair, depth, colour);
        ASSERT_TRUE(status.ok()) << status.message();
        EXPECT_TRUE(depth == MkvTestDepth(depth_index)) << "depth " << depth_index;
        ColourImage decoded;
        ASSERT_TRUE(DecodeJpeg(MkvTestJpeg(colour_index), 8192, decoded).ok());
        EXPECT_TRUE(colour == decoded) << "colour " << colour_index;
    }
    void ExpectRefused(const std::string& what) {
        const auto recording = Open();
        ASSERT_FALSE(recording.ok());
        EXPECT_NE(recording.message().find("a.mkv"), std::string::npos) << recording.message();
        EXPECT_NE(recording.message().find(what), std::string::npos) << recording.message();
    }
    static bool Mentions(const std::vector<std::string>& texts, const std::string& what) {
        for (const std::string& text : texts)
            if (text.find(what) != std::string::npos) return true;
        return false;
    }
    std::string Bytes() { return ReadText(folder.Path("a.mkv")); }

    TemporaryFolder folder;
    MkvRecipe recipe;
    Image<std::uint16_t> depth;
    ColourImage colour;
};

}  // namespace tessera
