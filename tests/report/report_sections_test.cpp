#include "report/report_sections.h"

#include <gtest/gtest.h>

#include "report/page_parts.h"

namespace tessera {
namespace {

TEST(ChangedSettings, ComparesNumbersAsNumbers) {
    RunRecord record;
    record.configuration = {{"a.same", "0.10"}, {"a.text", "icp"}, {"a.other", "2"}, {"gone", "1"}};
    const auto changed = ChangedSettings(
        record, {{"a.same", "m", "0.1"}, {"a.text", "", "sdf"}, {"a.other", "m", "1"}});
    ASSERT_EQ(changed.size(), 3u);
    EXPECT_EQ(changed[0].key, "a.text");
    EXPECT_EQ(changed[0].value, "icp");
    EXPECT_EQ(changed[0].default_value, "sdf");
    EXPECT_EQ(changed[1].value, "2 m");
    EXPECT_EQ(changed[1].default_value, "1 m");
    EXPECT_EQ(changed[2].default_value, "unknown to this version");
}

TEST(PageParts, NumbersWithUnits) {
    EXPECT_EQ(LengthText(0.00064), "0.64 mm");
    EXPECT_EQ(LengthText(0.032), "3.2 cm");
    EXPECT_EQ(LengthText(12.345), "12.35 m");
    EXPECT_EQ(LengthText(1234.4), "1234 m");
    EXPECT_EQ(DurationText(5), "5.0 s");
    EXPECT_EQ(DurationText(125.2), "2 min 5 s");
    EXPECT_EQ(CountText(0), "0");
    EXPECT_EQ(CountText(999), "999");
    EXPECT_EQ(CountText(1234567), "1,234,567");
    EXPECT_EQ(PercentText(1, 3), "33.3 %");
    EXPECT_EQ(PercentText(0, 0), "-");
}

}  // namespace
}  // namespace tessera
