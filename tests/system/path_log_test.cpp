#include "system/path_log.h"

#include <gtest/gtest.h>

namespace tessera {
namespace {

PathRecord RecordAt(std::int64_t index, TrackStatus status = TrackStatus::kGood) {
    PathRecord record;
    record.index = index;
    record.stamp_s = 0.1 * static_cast<double>(index);
    record.status = status;
    record.T_reference_camera.translation().x() = static_cast<double>(index);
    return record;
}

// Four frames, numbered from 10. The second one is lost.
class PathLogTest : public testing::Test {
  protected:
    PathLogTest() {
        log.Add(10, RecordAt(0), checkpoint);
        log.Add(11, RecordAt(1, TrackStatus::kLost), checkpoint);
        log.Add(12, RecordAt(2), checkpoint);
        log.Add(13, RecordAt(3), checkpoint);
    }
    static PathPose Passage(std::int64_t index, int keyframe) {
        return {RecordAt(index).stamp_s, keyframe,
                Eigen::Isometry3d(Eigen::Translation3d(0, 5, 0))};
    }
    std::vector<std::int64_t> Numbers() const {
        std::vector<std::int64_t> numbers;
        for (const auto& [number, record] : checkpoint.path) numbers.push_back(number);
        return numbers;
    }

    PathLog log{true};
    ScanCheckpoint checkpoint;
};

TEST_F(PathLogTest, TrackedFramesWaitForTheirPlaceAndMoveWithTheMap) {
    EXPECT_EQ(Numbers(), std::vector<std::int64_t>{11});
    log.Move(Eigen::Isometry3d(Eigen::Translation3d(100, 0, 0)));
    log.AddWaiting(checkpoint);
    ASSERT_EQ(Numbers(), (std::vector<std::int64_t>{11, 10, 12, 13}));
    EXPECT_EQ(checkpoint.path[2].second.keyframe, -1);
    EXPECT_EQ(checkpoint.path[2].second.T_reference_camera.translation().x(), 102);
}

TEST_F(PathLogTest, APlacedFrameIsWrittenOnceRelativeToItsKeyframe) {
    LoopChanges news;
    news.passages = {Passage(0, 4), Passage(3, 5)};  // frame 2 was left out
    log.Place(news, checkpoint);
    ASSERT_EQ(Numbers(), (std::vector<std::int64_t>{11, 10, 12, 13}));
    EXPECT_EQ(checkpoint.path[1].second.keyframe, 4);
    EXPECT_EQ(checkpoint.path[1].second.T_reference_camera.translation(), Eigen::Vector3d(0, 5, 0));
    EXPECT_EQ(checkpoint.path[2].second.keyframe, -1);
    EXPECT_EQ(checkpoint.path[3].second.keyframe, 5);
    log.AddWaiting(checkpoint);
    EXPECT_EQ(checkpoint.path.size(), 4u);
}

TEST_F(PathLogTest, FramesOfLoopClosureTakeTheNumberOfTheirPathAndTheRawOnesPlace) {
    checkpoint.raw_frames.emplace_back(10, std::make_unique<Frame>());
    checkpoint.raw_frames.emplace_back(12, std::make_unique<Frame>());
    LoopChanges news;
    news.passages = {Passage(0, 0), Passage(2, 0)};
    news.frames.resize(2);
    news.frames[0].frame_index = 2;
    news.frames[1].frame_index = 7;  // matches no known frame
    log.Place(news, checkpoint);
    ASSERT_EQ(checkpoint.frames.size(), 1u);
    EXPECT_EQ(checkpoint.frames[0].first, 12);
    EXPECT_TRUE(checkpoint.frames[0].second.in_store);
    ASSERT_EQ(checkpoint.raw_frames.size(), 1u);
    EXPECT_EQ(checkpoint.raw_frames[0].first, 10);
    // The frame is sent again after objects were found in it.
    LoopChanges later;
    later.frames.resize(1);
    later.frames[0].frame_index = 0;
    log.Place(later, checkpoint);
    EXPECT_EQ(checkpoint.frames.back().first, 10);
}

TEST(PathLog, WithoutLoopClosureNothingWaits) {
    PathLog log(false);
    ScanCheckpoint checkpoint;
    log.Add(0, RecordAt(0), checkpoint);
    EXPECT_EQ(checkpoint.path.size(), 1u);
}

}  // namespace
}  // namespace tessera
