#include "report/frames_table.h"

#include <gtest/gtest.h>

#include "io/file.h"
#include "report/made_up_run.h"
#include "support/temp_folder.h"

namespace tessera {
namespace {

class FramesTableFile : public testing::Test {
  protected:
    Result<FramesTable> Read(const std::string& text) const {
        EXPECT_TRUE(WriteTextFile(folder / "frames.csv", text).ok());
        return ReadFramesTable(folder / "frames.csv");
    }
    TempFolder folder;
};

TEST_F(FramesTableFile, ReadsStatesTimesAndReasons) {
    const auto table =
        Read(std::string(kFramesHeader) + FrameLine(4, "good", 1, "") +
             FrameLine(5, "poor", 0, "few, points") + FrameLine(6, "lost", 0, "none"));
    ASSERT_TRUE(table.ok()) << table.message();
    EXPECT_EQ(table.value().damage, "");
    const auto& rows = table.value().rows;
    ASSERT_EQ(rows.size(), 3u);
    EXPECT_EQ(rows[0].index, 4);
    EXPECT_DOUBLE_EQ(rows[0].stamp_s, 100.4);
    EXPECT_DOUBLE_EQ(rows[0].track_ms, 20.5);
    EXPECT_DOUBLE_EQ(rows[0].frame_ms, 50);
    EXPECT_EQ(rows[0].state, FrameState::kFused);
    EXPECT_EQ(rows[1].state, FrameState::kTracked);
    EXPECT_EQ(rows[1].reason, "few, points");
    EXPECT_EQ(rows[2].state, FrameState::kLost);
}

TEST_F(FramesTableFile, BadLinesAreLeftOutAndSaid) {
    const auto table = Read(std::string(kFramesHeader) + FrameLine(0, "good", 1, "") + "1,2,3\n" +
                            FrameLine(2, "?", 1, "") + FrameLine(3, "good", 1, "") + "half a li");
    ASSERT_TRUE(table.ok()) << table.message();
    EXPECT_EQ(table.value().rows.size(), 2u);
    EXPECT_EQ(table.value().damage,
              folder / "frames.csv" + ":3: 3 values instead of 14; 3 such lines are left out");
}

TEST_F(FramesTableFile, NumbersThatAreNone) {
    for (const char* bad : {"nan", "1e999", "x", "", "1 "}) {
        std::string line = FrameLine(0, "good", 1, "");
        line.replace(line.find("20.5"), 4, bad);
        const auto table = Read(std::string(kFramesHeader) + line);
        ASSERT_TRUE(table.ok()) << table.message();
        EXPECT_TRUE(table.value().rows.empty()) << bad;
        EXPECT_NE(table.value().damage.find("track_ms is not a number"), std::string::npos);
    }
}

TEST_F(FramesTableFile, AnotherFileIsAnError) {
    for (const char* text : {"", "a,b\n1,2\n", "\xff\xfe"}) {
        const auto table = Read(text);
        ASSERT_FALSE(table.ok());
        EXPECT_NE(table.message().find("frames.csv"), std::string::npos);
    }
}

}  // namespace
}  // namespace tessera
