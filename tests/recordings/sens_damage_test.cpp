#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "recordings/sens_fixture.h"
#include "recordings/sens_recording.h"

namespace tessera {
namespace {

using SensDamage = SensFixture;

TEST_F(SensDamage, AFileThatWasCutOffHasTheFramesBefore) {
    const SensTestFile sens = Raw(3);
    const std::string whole = sens.Bytes();
    SensTestFile header = sens;
    header.frames.clear();
    const std::size_t head = header.Bytes().size() - 8;
    const std::size_t frame = (whole.size() - 8 - head) / 3;
    for (std::size_t size = 0; size < whole.size() - 8; size += size < head ? 5 : 997) {
        const RecordingResult recording = Open(whole.substr(0, size));
        ASSERT_EQ(recording.ok(), size >= head + frame) << size;
        if (!recording.ok()) continue;
        const RecordingInfo& info = recording.value()->info();
        ASSERT_EQ(info.pairs.size(), (size - head) / frame);
        ASSERT_EQ(info.warnings.size(), 1u);
        EXPECT_NE(info.warnings[0].find("of its 3 frames"), std::string::npos);
        const std::size_t last = info.pairs.size() - 1;
        ASSERT_TRUE(recording.value()->Load(last, depth, colour).ok());
        EXPECT_EQ(depth, SensDepthOf(static_cast<int>(last)));
    }
    SensTestFile unclosed = sens;
    unclosed.count = 0;  // the recorder writes the number of frames last
    EXPECT_EQ(Opened(unclosed)->info().pairs.size(), 3u);
    EXPECT_EQ(Opened(unclosed)->info().warnings,
              std::vector<std::string>{"the recording was not closed; 3 frames were found"});
    SensTestFile padded = sens;  // with empty space that was set aside
    padded.count = 100;
    EXPECT_EQ(Open(padded.Bytes() + std::string(5000, '\0')).value()->info().pairs.size(), 3u);
}

TEST_F(SensDamage, ClaimedSizesAllocateNothing) {
    SensTestFile sens = Raw(2);
    sens.count = std::uint64_t{1} << 60;
    EXPECT_EQ(Opened(sens)->info().pairs.size(), 2u);
    std::string bytes = Raw(2).Bytes();
    const std::size_t sizes = bytes.size() - 8 - 64 * 48 * 3 - 32 * 24 * 2 - 16;
    for (const std::uint64_t huge :
         {std::uint64_t{1} << 29, std::uint64_t{1} << 28, ~std::uint64_t{0}}) {
        std::string field;
        SensTestFile::Put(field, huge);
        const RecordingResult recording = Open(std::string(bytes).replace(sizes, 8, field));
        ASSERT_TRUE(recording.ok()) << recording.message();
        EXPECT_EQ(recording.value()->info().pairs.size(), 1u);
        EXPECT_EQ(recording.value()->info().warnings.size(), 1u);
    }
}

TEST_F(SensDamage, ADamagedFrameIsRefusedAlone) {
    SensTestFile sens = Raw(6);
    sens.depth_kind = 1;
    sens.colour_kind = 2;
    for (SensTestFrame& frame : sens.frames) {
        frame.depth = SensTestZlib(SensDepthOf(1));
        frame.colour = SensTestJpeg(SensColourOf(1));
    }
    sens.frames[1].depth[60] = static_cast<char>(sens.frames[1].depth[60] ^ 0x55);
    sens.frames[2].colour = "no JPEG";
    sens.frames[3].colour = SensTestPng(ColourImage(60, 48));
    sens.frames[4].colour = "";
    sens.frames[5].depth = "";
    const auto recording = Opened(sens);
    const auto message = [&](std::size_t i) { return recording->Load(i, depth, colour).message(); };
    EXPECT_EQ(message(0), "");
    EXPECT_EQ(message(1), "depth is damaged, or not of 32 x 24 pixels");
    EXPECT_EQ(message(2), "colour is no JPEG or PNG image of 64 x 48 pixels");
    EXPECT_EQ(message(3), "colour is no JPEG or PNG image of 64 x 48 pixels");
    EXPECT_EQ(message(4), "");
    EXPECT_TRUE(colour.empty());
    EXPECT_EQ(message(5), "depth is damaged, or not of 32 x 24 pixels");
    EXPECT_EQ(message(0), "");
    EXPECT_EQ(depth, SensDepthOf(1));
}

TEST_F(SensDamage, WhatIsNoRecordingIsRefusedByName) {
    const auto with = [](auto change) {
        SensTestFile sens = Raw(1);
        change(sens);
        return sens;
    };
    Refused("", "is no ScanNet recording");
    Refused("This is a text, and not a recording.", "is no ScanNet recording");
    Refused(with([](auto& s) { s.version = 3; }), "has version 3");
    Refused(with([](auto& s) { s.depth_kind = 2; }), "occi");
    Refused(with([](auto& s) { s.depth_kind = -1; }), "unknown compression -1");
    Refused(with([](auto& s) { s.colour_kind = 3; }), "unknown compression 3");
    Refused(with([](auto& s) { s.depth_width = 8193; }), "not plausible");
    Refused(with([](auto& s) { s.colour_height = 0; }), "not plausible");
    Refused(with([](auto& s) { s.depth_shift = std::nanf(""); }), "depth shift of nan");
    Refused(with([](auto& s) { s.frames.clear(); }), "no complete frame");
    const RecordingResult missing = OpenSensRecording(folder.Path("b.sens"));
    ASSERT_FALSE(missing.ok());
    EXPECT_NE(missing.message().find("b.sens: no such file"), std::string::npos);
}

TEST_F(SensDamage, MutatedFilesNeverCrash) {
    SensTestFile sens = Raw(2);
    sens.depth_kind = 1;
    sens.colour_kind = 1;
    for (int i = 0; i < 2; ++i) {
        sens.frames[static_cast<std::size_t>(i)].depth = SensTestZlib(SensDepthOf(i));
        sens.frames[static_cast<std::size_t>(i)].colour = SensTestPng(SensColourOf(i));
    }
    std::mt19937 random(5);
    for (int run = 0; run < 500; ++run) {
        std::string bytes = sens.Bytes();
        for (std::size_t n = 1 + random() % 8; n > 0; --n) {
            // Every other time in the header, which is a small part of the file.
            const std::size_t at = random() % (random() % 2 == 0 ? 420 : bytes.size());
            bytes[at] = static_cast<char>(random() % 4 == 0 ? 0xff : random() % 256);
        }
        if (random() % 8 == 0) bytes.resize(random() % bytes.size());
        const RecordingResult recording = Open(bytes);
        if (!recording.ok()) continue;
        for (std::size_t i = 0; i < recording.value()->info().pairs.size(); ++i)
            if (recording.value()->Load(i, depth, colour).ok()) {
                EXPECT_FALSE(depth.empty());
            }
    }
}

}  // namespace
}  // namespace tessera
