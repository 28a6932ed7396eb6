#include "io/chosen_frames.h"

#include <gtest/gtest.h>

#include "counting_source.h"

namespace tessera {
namespace {

TEST(ChosenFrames, AreReadInTheGivenOrder) {
    CountingSource source({.skipped = {4}, .waits = {7}});
    ChosenFrames chosen(source, {1, 4, 7, 3});
    EXPECT_EQ(chosen.info().frame_count, 4);
    Frame frame;
    ASSERT_EQ(chosen.Read(frame).status, ReadStatus::kOk);
    EXPECT_EQ(frame.index, 1);
    EXPECT_EQ(chosen.Read(frame).status, ReadStatus::kSkip);
    EXPECT_EQ(chosen.Read(frame).status, ReadStatus::kWait);
    ASSERT_EQ(chosen.Read(frame).status, ReadStatus::kOk);
    EXPECT_EQ(frame.index, 7);
    ASSERT_EQ(chosen.Read(frame).status, ReadStatus::kOk);
    EXPECT_EQ(frame.index, 3);
    EXPECT_EQ(chosen.Read(frame).status, ReadStatus::kEnd);
    ASSERT_TRUE(chosen.Seek(2));
    EXPECT_FALSE(chosen.Seek(5));
    ASSERT_EQ(chosen.Read(frame).status, ReadStatus::kOk);
    EXPECT_EQ(frame.index, 7);
}

TEST(ChosenFrames, EndWhereTheSourceCannotSeek) {
    CountingSource source({.seeks = false});
    ChosenFrames chosen(source, {1, 2});
    Frame frame;
    EXPECT_EQ(chosen.Read(frame).status, ReadStatus::kEnd);
}

}  // namespace
}  // namespace tessera
