#include "optimize/shown_drift.h"

#include <gtest/gtest.h>

#include <utility>
#include <vector>

namespace tessera {
namespace {

constexpr double kLeast_m = 0.01, kMaxDrift = 0.05;

// Keyframes at one place.
class ShownDriftTest : public testing::Test {
  protected:
    explicit ShownDriftTest() : keyframes_(10) {}

    void Grow(std::size_t count) { keyframes_.resize(count); }
    // Keyframe `id` was tracked at keyframe `with`, and aligned so far beside it.
    void Show(int id, int with, double off_m) {
        Overlap overlap{with, Eigen::Isometry3d(Eigen::Translation3d(off_m, 0, 0)),
                        1e6 * Matrix6d::Identity(), Eigen::Isometry3d::Identity()};
        keyframes_[static_cast<std::size_t>(id)].overlaps.push_back(overlap);
    }
    ShownDrift Find() {
        for (std::size_t i = 0; i < keyframes_.size(); ++i) keyframes_[i].id = static_cast<int>(i);
        list_.Resume(keyframes_);
        return FindShownDrift(list_, 1, kLeast_m, kMaxDrift);
    }

  private:
    std::vector<Keyframe> keyframes_;
    Keyframes list_{PinholeCamera{}, 0.8, 100};
};

TEST_F(ShownDriftTest, NeedsTwoWitnessesAmongTheLastFew) {
    Show(9, 1, 0.03);
    EXPECT_FALSE(Find().worth_a_solution);
    Show(6, 0, 0.02);  // not one of the last three
    EXPECT_FALSE(Find().worth_a_solution);
    Show(8, 0, 0.02);
    const ShownDrift shown = Find();
    EXPECT_TRUE(shown.worth_a_solution);
    ASSERT_NE(shown.old, nullptr);
    EXPECT_EQ(shown.old->id, 1);
    EXPECT_DOUBLE_EQ(shown.drift.off_m, 0.03);
}

TEST_F(ShownDriftTest, WhatCannotBeIsNone) {
    Show(9, 0, 0.03);
    Show(9, 1, 0.009);  // less than counts
    Show(9, 2, 2);      // another place
    Show(9, 6, 0.03);   // one of the last few before it
    EXPECT_FALSE(Find().worth_a_solution);
    EXPECT_EQ(Find().old, nullptr);
}

TEST_F(ShownDriftTest, ThatCameToNothingIsSoughtAgainFromTimeToTime) {
    for (const auto& [count, worth] : {std::pair{49, true},
                                       {50, false},  // every second from here on
                                       {51, true},
                                       {500, false},  // every eleventh
                                       {507, true},
                                       {508, false}}) {
        Grow(0);
        Grow(static_cast<std::size_t>(count));
        for (int id = 10; id < count; ++id) Show(id, 0, 0.03);
        EXPECT_EQ(Find().worth_a_solution, worth) << count;
        Show(count - 1, 1, 0.031);  // news
        EXPECT_TRUE(Find().worth_a_solution) << count;
    }
}

}  // namespace
}  // namespace tessera
