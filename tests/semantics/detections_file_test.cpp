#include "semantics/detections_file.h"

#include <gtest/gtest.h>

#include <fstream>

#include "support/temp_folder.h"

namespace tessera {
namespace {

Result<std::unique_ptr<DetectionsFile>> Parse(const std::string& text) {
    static int count = 0;
    const std::string path = ProcessFolder() + "/detections" + std::to_string(count++) + ".txt";
    std::ofstream(path) << text;
    return DetectionsFile::Read(path);
}

TEST(DetectionsFile, ByTheColourImagesStamp) {
    auto file = Parse(
        "# a comment\n1000.0 cup 0.9 1 2 3 4\r\n\n1000.033333 cell_phone 0.4 10 20 30 40 # "
        "late\n1000 tv 1 0 0 5 5\n");
    ASSERT_TRUE(file.ok()) << file.message();
    EXPECT_EQ(file.value()->class_names(), (std::vector<std::string>{"cell_phone", "cup", "tv"}));
    Frame frame;
    frame.stamp_s = 1000.0333;
    frame.colour_stamp_s = 1000.0005;
    const auto early = file.value()->Detect(frame).value();
    ASSERT_EQ(early.size(), 2u);
    EXPECT_EQ(early[0].name, "cup");
    EXPECT_EQ(early[0].box, (DetectionBox{1, 2, 3, 4}));
    EXPECT_EQ(early[1].name, "tv");
    frame.colour_stamp_s = 1000.2;  // no detections, so those of the depth image are used
    EXPECT_EQ(file.value()->Detect(frame).value().size(), 1u);
    frame.stamp_s = 1000.016;  // between two frames, so it matches neither
    EXPECT_TRUE(file.value()->Detect(frame).value().empty());
    frame.stamp_s = frame.colour_stamp_s = 2000;
    EXPECT_TRUE(file.value()->Detect(frame).value().empty());
}

TEST(DetectionsFile, RowsHaveTheStampsAsRecorded) {
    auto file = Parse("1000.0 cup 0.9 1 2 3 4\n1000.05 tv 0.9 1 2 3 4\n");
    ASSERT_TRUE(file.ok()) << file.message();
    Frame frame;
    frame.correction = {-0.02, 0.03};
    frame.stamp_s = 1000.049 - 0.02;
    frame.colour_stamp_s = 1000 + 0.03;
    auto found = file.value()->Detect(frame).value();
    ASSERT_EQ(found.size(), 1u);
    EXPECT_EQ(found[0].name, "cup");
    frame.colour_stamp_s = 2000;
    found = file.value()->Detect(frame).value();
    ASSERT_EQ(found.size(), 1u);
    EXPECT_EQ(found[0].name, "tv");
}

TEST(DetectionsFile, ABadLineIsNamed) {
    const std::string good = "1000 cup 0.9 1 2 3 4\n";
    for (const auto& [line, why] : {std::pair{"1000 cup 0.9 1 2 3", "expected"},
                                    {"1000 cup 0.9 1 2 3 4 5", "expected"},
                                    {"x cup 0.9 1 2 3 4", "expected"},
                                    {"1000 cup 1.5 1 2 3 4", "probability 1.5"},
                                    {"1000 cup 0.9 9 2 3 4", "empty"},
                                    {"1000 cup 0.9 1 2 3e9 4", "out of range"}}) {
        const auto file = Parse(good + line + "\n");
        EXPECT_FALSE(file.ok());
        EXPECT_NE(file.message().find(":2: "), std::string::npos) << file.message();
        EXPECT_NE(file.message().find(why), std::string::npos) << file.message();
    }
    EXPECT_NE(Parse("# nothing\n").message().find("no detections"), std::string::npos);
    EXPECT_FALSE(DetectionsFile::Read(ProcessFolder() + "/none.txt").ok());
}

TEST(DetectionsFile, WhatItWritesItReads) {
    const Detection written{"cup", 5, 0.75f, {1.5f, 2, 3, 4}, {}};
    auto file = Parse(DetectionLine(12.345678, "cup", written) + "\n");
    ASSERT_TRUE(file.ok()) << file.message();
    Frame frame;
    frame.stamp_s = frame.colour_stamp_s = 12.345678;
    const auto read = file.value()->Detect(frame).value();
    ASSERT_EQ(read.size(), 1u);
    EXPECT_EQ(read[0].box, written.box);
    EXPECT_FLOAT_EQ(read[0].probability, 0.75f);
}

}  // namespace
}  // namespace tessera
