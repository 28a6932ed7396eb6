#include "run/timings.h"

#include <gtest/gtest.h>

#include "core/process.h"

namespace tessera {
namespace {

TEST(Timings, KnownAnswers) {
    const StageStatistics odd = SummariseDurations({5, 1, 3});
    EXPECT_EQ(odd.mean_ms, 3);
    EXPECT_EQ(odd.median_ms, 3);
    EXPECT_EQ(odd.p95_ms, 5);
    EXPECT_EQ(odd.max_ms, 5);
    EXPECT_EQ(SummariseDurations({4, 1, 2, 10}).median_ms, 3);
    EXPECT_EQ(SummariseDurations({7}).p95_ms, 7);
    EXPECT_EQ(SummariseDurations({}).max_ms, 0);

    std::vector<double> hundred;
    for (int i = 100; i >= 1; --i) hundred.push_back(i);
    EXPECT_EQ(SummariseDurations(hundred).p95_ms, 95);
    EXPECT_EQ(SummariseDurations(hundred).median_ms, 50.5);
}

TEST(Timings, StagesKeepTheirOrderAndTheirOwnDurations) {
    StageTimes times;
    times.Add("track", 1);
    times.Add("fuse", 10);
    times.Add("track", 3);
    const auto summary = times.Summarise();
    ASSERT_EQ(summary.size(), 2u);
    EXPECT_EQ(summary[0].first, "track");
    EXPECT_EQ(summary[0].second.mean_ms, 2);
    EXPECT_EQ(summary[1].first, "fuse");
    EXPECT_EQ(summary[1].second.mean_ms, 10);
}

TEST(Timings, TheProcessHasUsedSomething) {
    volatile double sink = 0;
    const double before_s = MeasureProcess().cpu_s;
    while (MeasureProcess().cpu_s <= before_s) sink = sink + 1;
    EXPECT_GT(MeasureProcess().peak_rss_mb, 1);
    EXPECT_LT(MeasureProcess().peak_rss_mb, 1e6);
}

}  // namespace
}  // namespace tessera
