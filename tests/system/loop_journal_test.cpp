#include "system/loop_journal.h"

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

}  // namespace
}  // namespace tessera
