// Azure Kinect recordings that were cut off or damaged.
#include <gtest/gtest.h>

#include <random>

#include "recordings/mkv_fixture.h"

namespace tessera {
namespace {

class MkvDamage : public MkvFixture {};

TEST_F(MkvDamage, WhatIsCutOffIsMissing) {
    ASSERT_TRUE(WriteAndOpen().ok());
    const std::string whole = Bytes();
    std::size_t before = 6;
    for (const double part : {0.95, 0.7, 0.5, 0.2}) {
        folder.WriteText(
            "a.mkv",
            whole.substr(0, static_cast<std::size_t>(part * static_cast<double>(whole.size()))));
        const auto recording = Open();
        ASSERT_TRUE(recording.ok()) << recording.message();
        const RecordingInfo& info = recording.value()->info();
        ASSERT_FALSE(info.warnings.empty());
        EXPECT_NE(info.warnings[0].find("cut off or damaged at byte"), std::string::npos);
        EXPECT_LT(info.pairs.size(), before);
        before = info.pairs.size();
        ASSERT_GE(before, 1u);
        for (std::size_t i = 0; i < before; ++i)
            ExpectPair(*recording.value(), i, static_cast<int>(i), static_cast<int>(i));
    }
    folder.WriteText("a.mkv", whole.substr(0, 1000));
    ExpectRefused("the track");
    folder.WriteText("a.mkv", whole.substr(0, 30));
    ExpectRefused("plain video");
}

TEST_F(MkvDamage, ADamagedClusterCostsItsImagesOnly) {
    ASSERT_TRUE(WriteAndOpen().ok());
    std::string bytes = Bytes();
    const std::string cluster{0x1f, 0x43, '\xb6', 0x75};
    std::size_t fifth = 0;  // ffmpeg makes a cluster for each image; depth and colour take turns
    for (int i = 0; i < 5; ++i) fifth = bytes.find(cluster, fifth + 1);
    ASSERT_NE(fifth, std::string::npos);
    bytes.replace(fifth, 2000, 2000, '\0');
    folder.WriteText("a.mkv", bytes);
    const auto recording = Open();
    ASSERT_TRUE(recording.ok()) << recording.message();
    const RecordingInfo& info = recording.value()->info();
    EXPECT_TRUE(Mentions(info.warnings, "damaged in 1 place"));
    ASSERT_EQ(info.pairs.size(), 5u);
    for (std::size_t i = 0; i < 5; ++i) {
        const int image = static_cast<int>(i) + (i < 2 ? 0 : 1);
        ExpectPair(*recording.value(), i, image, image);
    }
}

TEST_F(MkvDamage, ADamagedImageIsOneError) {
    ASSERT_TRUE(WriteAndOpen().ok());
    std::string bytes = Bytes();
    const auto jpeg = MkvTestJpeg(1);
    const std::size_t at = bytes.find(std::string(jpeg.begin(), jpeg.end()));
    ASSERT_NE(at, std::string::npos);
    bytes.replace(at + jpeg.size() / 2, 40, 40, '\xff');
    folder.WriteText("a.mkv", bytes);
    const auto recording = Open();
    ASSERT_TRUE(recording.ok()) << recording.message();
    ExpectPair(*recording.value(), 0, 0, 0);
    const Status status = recording.value()->Load(1, depth, colour);
    ASSERT_FALSE(status.ok());
    EXPECT_TRUE(status.message().starts_with("colour ")) << status.message();
    ExpectPair(*recording.value(), 2, 2, 2);
}

// Any damage is an error, a warning or other pixels; nothing is read or allocated beyond the file.
TEST_F(MkvDamage, DamagedBytesDoNoHarm) {
    recipe.depth_count = recipe.colour_count = 1;
    ASSERT_TRUE(WriteAndOpen().ok());
    const std::string whole = Bytes();
    const std::size_t head = whole.find({0x1f, 0x43, '\xb6', 0x75}) + 100;
    std::mt19937 random(20);
    int opened = 0, loaded = 0;
    for (int i = 0; i < 200; ++i) {
        std::string bytes = whole;
        for (int k = 0; k < 1 + i % 3; ++k) {
            const std::size_t reach = i % 4 == 0 ? bytes.size() : head;
            bytes[random() % reach] = static_cast<char>(random() % 256);
        }
        folder.WriteText("a.mkv", bytes);
        const auto recording = Open();
        if (!recording.ok()) continue;
        ++opened;
        for (std::size_t p = 0; p < recording.value()->info().pairs.size(); ++p)
            if (recording.value()->Load(p, depth, colour).ok()) ++loaded;
    }
    EXPECT_GT(opened, 80);
    EXPECT_GT(loaded, 80);
}

}  // namespace
}  // namespace tessera
