// A scan that is lost right after its start begins again.
#include "system/start_watch.h"

#include "system/engine_fixture.h"
#include "system/frame_list.h"

namespace tessera {
namespace {

using testing_support::FrameList;
using testing_support::RoomWalk;

TrackedFrame At(double stamp_s, TrackStatus status) {
    TrackedFrame tracked;
    tracked.prepared.valid_depth_pixels = 1;
    tracked.report.stamp_s = stamp_s;
    tracked.report.track.status = status;
    return tracked;
}

constexpr TrackStatus kGood = TrackStatus::kGood, kLost = TrackStatus::kLost;

TEST(StartWatch, WaitsForASecondAndForAsManyFrames) {
    for (const int good : {1, 4, 10}) {
        StartWatch watch;
        for (int i = 0; i < good; ++i) watch.Add(At(i, kGood));
        for (int i = 1; i <= good; ++i) {
            EXPECT_FALSE(watch.failed()) << good;
            watch.Add(At(good - 1 + i, kLost));
        }
        EXPECT_TRUE(watch.failed()) << good;
        watch.Clear();
        EXPECT_FALSE(watch.failed());
        watch.Add(At(90, kLost));  // nothing has begun yet
        EXPECT_FALSE(watch.failed());
    }
    StartWatch watch;
    watch.Add(At(10, kGood));
    watch.Add(At(10.875, kLost));
    EXPECT_FALSE(watch.failed());
    watch.Add(At(11, kLost));
    EXPECT_TRUE(watch.failed());
}

TEST(StartWatch, ALongerScanIsNeverThrownAway) {
    StartWatch watch;
    for (int i = 0; i < 11; ++i) watch.Add(At(i, kGood));
    for (int i = 11; i < 99; ++i) watch.Add(At(i, kLost));
    EXPECT_FALSE(watch.failed());
}

TEST(StartWatch, ACoveredCameraHasNothingToBeginWith) {
    StartWatch watch;
    watch.Add(At(0, kGood));
    TrackedFrame covered = At(5, kLost);
    covered.prepared.valid_depth_pixels = 0;
    watch.Add(covered);
    EXPECT_FALSE(watch.failed());
    watch.Add(At(5.125, kLost));
    EXPECT_TRUE(watch.failed());
    watch.Add(At(5.25, TrackStatus::kPoor));  // it may find its way
    EXPECT_FALSE(watch.failed());
}

class LostStart : public EngineTest, public testing::WithParamInterface<bool> {};

// Two frames of one place, then two seconds of another.
TEST_P(LostStart, BeginsAgain) {
    std::vector<Frame> frames = RoomWalk(0, 2, 1);
    for (Frame& frame : RoomWalk(200, 60, 1)) frames.push_back(std::move(frame));
    config.live = {};
    config.live.queue_frames = 100;
    EngineInput input = Input({});
    input.source = std::make_unique<FrameList>(std::move(frames));
    if (GetParam())
        engine = std::make_unique<LiveEngine>(std::move(input));
    else
        engine = std::make_unique<LockstepEngine>(std::move(input));
    TakeAll();
    EXPECT_EQ(Count(Kind::kReset), 1);
    EXPECT_NE(Messages().find(kStartFailed), std::string::npos) << Messages();
    const auto reports = Reports();
    ASSERT_EQ(reports.size(), 62u);
    EXPECT_FALSE(reports[10]->tracked());
    EXPECT_TRUE(reports.back()->fused) << reports.back()->track.reason;
    const auto first = std::ranges::find_if(reports.begin() + 1, reports.end(),
                                            [](const FrameReport* r) { return r->first; });
    ASSERT_NE(first, reports.end());
    EXPECT_NEAR((*first)->stamp_s - reports[1]->stamp_s, 1 + 1.0 / 30, 0.05);
    EXPECT_GT(engine->map_statistics().blocks, 100);
}
INSTANTIATE_TEST_SUITE_P(Engines, LostStart, testing::Bool());

}  // namespace
}  // namespace tessera
