// Small .sens files in a temporary folder, and what must be read from them.
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <string>

#include "io/temporary_folder.h"
#include "recordings/sens_recording.h"
#include "recordings/sens_writer.h"

namespace tessera {

// Different in each pixel and frame.
inline Image<std::uint16_t> SensDepthOf(int frame) {
    Image<std::uint16_t> depth(32, 24);
    for (int y = 0; y < 24; ++y)
        for (int x = 0; x < 32; ++x)
            depth(x, y) = static_cast<std::uint16_t>(x * 1999 + y * 77 + frame * 1000);
    return depth;
}

inline ColourImage SensColourOf(int frame) {
    ColourImage colour(64, 48);
    for (int y = 0; y < 48; ++y)
        for (int x = 0; x < 64; ++x)
            colour(x, y) = {static_cast<std::uint8_t>(3 * x), static_cast<std::uint8_t>(5 * y),
                            static_cast<std::uint8_t>(40 * frame)};
    return colour;
}

class SensFixture : public ::testing::Test {
  protected:
    // Raw colour and depth; frame i is at 0.1 i + 2 seconds.
    static SensTestFile Raw(int count) {
        SensTestFile sens;
        sens.colour_kind = sens.depth_kind = 0;
        for (int i = 0; i < count; ++i)
            sens.frames.push_back({static_cast<std::uint64_t>(2'000'500 + 100'000 * i),
                                   static_cast<std::uint64_t>(2'000'000 + 100'000 * i),
                                   SensTestRaw(SensColourOf(i)), SensTestRaw(SensDepthOf(i))});
        return sens;
    }
    RecordingResult Open(const std::string& bytes) {
        folder.WriteText("a.sens", bytes);
        return OpenSensRecording(folder.Path("a.sens"));
    }
    std::unique_ptr<Recording> Opened(const SensTestFile& sens) {
        RecordingResult recording = Open(sens.Bytes());
        EXPECT_TRUE(recording.ok()) << recording.message();
        return recording.ok() ? std::move(recording.value()) : nullptr;
    }
    void Refused(const std::string& bytes, const std::string& what) {
        const RecordingResult recording = Open(bytes);
        ASSERT_FALSE(recording.ok()) << what;
        EXPECT_NE(recording.message().find("a.sens: "), std::string::npos);
        EXPECT_NE(recording.message().find(what), std::string::npos) << recording.message();
    }
    void Refused(const SensTestFile& sens, const std::string& what) { Refused(sens.Bytes(), what); }

    TemporaryFolder folder;
    Image<std::uint16_t> depth;
    ColourImage colour;
};

}  // namespace tessera
