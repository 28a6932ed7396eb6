#include "system/loop_journal.h"

#include <optional>

#include "optimize/room_walk.h"

namespace tessera {
namespace {

using testing_support::RoomWalk;
using testing_support::Walker;

// Frames that are stored during a walk with a sharp turn each: more than one Take gives later.
void Walk(Walker& walker, int first, int count) {
    for (const Frame& frame : RoomWalk(first, count, 10))
        walker.Go(frame, Eigen::Isometry3d(Eigen::Translation3d(0, 0, 0.4)));
}

// Without them a scan that is saved in the middle of a run, and cut off soon after, would have
// keyframes without their frames.
TEST(LoopJournal, WhatWasBeforeIsTakenAtOnce) {
    Walker walker(LoopConfig{});
    Walk(walker, 0, 12);
    const std::vector<StoredFrame>& stored = walker.closer.store().frames();
    ASSERT_GT(stored.size(), 8u);
    LoopJournal journal;
    const LoopChanges first = journal.Take(walker.closer);
    EXPECT_EQ(first.frames.size(), stored.size());
    EXPECT_EQ(std::ssize(first.keyframes), walker.closer.keyframes().size());
    EXPECT_TRUE(journal.Take(walker.closer).frames.empty());
    Walk(walker, 120, 12);
    EXPECT_EQ(journal.Take(walker.closer).frames.size(), 4u);
    EXPECT_EQ(journal.Take(walker.closer, 3).frames.size(), 3u);
}

// The scan file has that already.
TEST(LoopJournal, WhatAnEarlierSessionHadIsNotTaken) {
    Walker walker(LoopConfig{});
    Walk(walker, 0, 12);
    LoopJournal journal;
    journal.Begin(walker.closer);
    EXPECT_TRUE(journal.Take(walker.closer).frames.empty());
    Walk(walker, 120, 12);
    EXPECT_EQ(journal.Take(walker.closer).frames.size(), 4u);
}

// All constraints so far, for each frame of a long scan, would be much to copy and to write.
TEST(LoopJournal, TheConstraintsAreTakenWhenThereAreMore) {
    LoopConfig config;
    config.average_frames = false;
    Walker walker(config);
    Walk(walker, 0, 12);
    const Frame again = RoomWalk(110, 1, 10).front();
    for (int i = 0; i < 3; ++i) walker.Go(again, Eigen::Isometry3d::Identity());  // stands still
    LoopJournal journal;
    journal.Begin(walker.closer);
    const std::optional<LoopProgress> first = journal.Take(walker.closer).progress;
    ASSERT_TRUE(first.has_value());
    EXPECT_EQ(first->edges.size(), walker.closer.graph().edges().size());
    EXPECT_FALSE(journal.Take(walker.closer).progress.has_value());
    // No new keyframe, but a new frame.
    const std::int64_t before = walker.closer.store().next_ordinal();
    const int keyframes = walker.closer.keyframes().size();
    walker.Go(again, Eigen::Isometry3d::Identity());
    ASSERT_EQ(walker.closer.keyframes().size(), keyframes);
    ASSERT_EQ(walker.closer.store().next_ordinal(), before + 1);
    EXPECT_FALSE(journal.Take(walker.closer).progress.has_value());
    const std::size_t all = walker.closer.store().frames().size();
    const std::optional<LoopProgress> last = journal.Take(walker.closer, all).progress;
    ASSERT_TRUE(last.has_value());
    EXPECT_EQ(last->next_ordinal, before + 1);
    Walk(walker, 120, 2);
    ASSERT_GT(walker.closer.graph().edges().size(), first->edges.size());
    const std::optional<LoopProgress> more = journal.Take(walker.closer).progress;
    ASSERT_TRUE(more.has_value());
    EXPECT_EQ(more->edges.size(), walker.closer.graph().edges().size());
}

}  // namespace
}  // namespace tessera
