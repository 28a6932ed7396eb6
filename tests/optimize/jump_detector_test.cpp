#include "optimize/jump_detector.h"

#include <gtest/gtest.h>

#include <random>

#include "core/se3.h"

namespace tessera {
namespace {

Eigen::Isometry3d At(double x) { return Eigen::Isometry3d(Eigen::Translation3d(x, 0, 0)); }

double Stamp_s(int frame) { return frame / 30.0; }

TEST(JumpDetector, KnowsASlipFromAStep) {
    JumpDetector detector;
    for (int i = 0; i < 20; ++i) EXPECT_FALSE(detector.Follow(Stamp_s(i), At(0.03 * i))) << i;
    const auto expected = detector.Follow(Stamp_s(20), At(0.03 * 20 + 0.05));
    ASSERT_TRUE(expected);
    EXPECT_TRUE(expected->isApprox(At(0.03 * 20), 1e-12));
    for (int i = 21; i < 30; ++i)
        EXPECT_FALSE(detector.Follow(Stamp_s(i), At(0.03 * i + 0.05))) << i;
}

TEST(JumpDetector, AFrameThatIsMissingIsNoJumpAndHidesNone) {
    for (const double slip_m : {0.0, 0.05}) {
        JumpDetector detector;
        for (int i = 0; i < 20; ++i) detector.Follow(Stamp_s(i), At(0.03 * i));
        const auto expected = detector.Follow(Stamp_s(21), At(0.03 * 21 + slip_m));
        ASSERT_EQ(expected.has_value(), slip_m > 0);
        EXPECT_TRUE(expected.value_or(At(0.03 * 21)).isApprox(At(0.03 * 21), 1e-9));
        for (int i = 22; i < 30; ++i)
            EXPECT_FALSE(detector.Follow(Stamp_s(i), At(0.03 * i + slip_m))) << i;
    }
}

TEST(JumpDetector, WhereManyFramesAreMissingOrTimeGoesBackNothingIsExpected) {
    for (const double next_s : {Stamp_s(30), Stamp_s(19), Stamp_s(10)}) {
        JumpDetector detector;
        for (int i = 0; i < 20; ++i) detector.Follow(Stamp_s(i), At(0.03 * i));
        for (int i = 0; i < 9; ++i)  // the camera has stopped elsewhere
            EXPECT_FALSE(detector.Follow(next_s + Stamp_s(i), At(1))) << next_s << " " << i;
        EXPECT_TRUE(detector.Follow(next_s + Stamp_s(9), At(1.05))) << next_s;
    }
}

TEST(JumpDetector, AMovedMapIsNoJumpAndALossIsNone) {
    JumpDetector detector;
    for (int i = 0; i < 5; ++i) detector.Follow(Stamp_s(i), At(0.01 * i));
    detector.Move(At(1));
    EXPECT_FALSE(detector.Follow(Stamp_s(5), At(1.05)));
    detector.Reset();
    EXPECT_FALSE(detector.Follow(Stamp_s(6), At(7)));
    EXPECT_FALSE(detector.Follow(Stamp_s(7), At(7.01)));
}

TEST(JumpDetector, AShakyHandIsTakenAsItIs) {
    JumpDetector detector;
    std::mt19937 random(1);
    std::normal_distribution<double> shake(0, 0.03);
    int jumps = 0;
    for (int i = 0; i < 200; ++i) {
        const bool jump =
            detector
                .Follow(Stamp_s(i),
                        Se3Exp((Vector6d() << shake(random), shake(random), 0, 0, 0, shake(random))
                                   .finished()))
                .has_value();
        jumps += jump && i >= 60;  // after the detector has learnt the shake
    }
    EXPECT_EQ(jumps, 0);
}

}  // namespace
}  // namespace tessera
