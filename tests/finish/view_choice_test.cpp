#include "finish/view_choice.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "finish/wall_frames.h"

namespace tessera {
namespace {

using testing_support::WallCamera;
using testing_support::WallFrame;

// The camera moves by `step_m` a frame and looks in direction turn_rad(i).
template <class Turn>
std::vector<StampedPose> Path(int count, const Turn& turn_rad, double step_m = 0.01) {
    std::vector<StampedPose> path;
    for (int i = 0; i < count; ++i) {
        Eigen::Isometry3d T(Eigen::AngleAxisd(turn_rad(i), Eigen::Vector3d::UnitY()));
        T.translation().x() = step_m * i;
        path.push_back({i / 30.0, T});
    }
    return path;
}

Frame At(double stamp_s, bool blurred = false) {
    Frame frame = WallFrame({0, 0, -1}, 0);
    frame.stamp_s = stamp_s;
    if (blurred) frame.colour = ColourImage(160, 120, Rgb8{100, 100, 100});
    return frame;
}

// The number of the frame on the path of each candidate.
std::vector<int> Numbers(const ViewChoice& choice) {
    std::vector<int> numbers;
    for (const double stamp_s : choice.stamps_s())
        numbers.push_back(static_cast<int>(std::lround(30 * stamp_s)));
    return numbers;
}

TEST(ViewChoice, CandidatesAreWhereTheCameraTurnsLeast) {
    // 0.055 m are five frames. The camera turns more and more slowly until frame 8, then faster. At
    // the path's ends it is not known to turn.
    const auto path = Path(
        12, [](int i) { return 2e-5 * std::pow(i - 8.1, 3); }, 0.011);
    EXPECT_EQ(Numbers(ViewChoice(path, WallCamera())),
              (std::vector<int>{0, 3, 4, 7, 8, 9, 10, 11}));
}

TEST(ViewChoice, TakesTheSharpestOfEachStretch) {
    const auto path = Path(25, [](int) { return 0.0; });
    ViewChoice choice(path, WallCamera());
    const std::vector<int> numbers = Numbers(choice);
    std::vector<double> chosen_s;
    for (std::size_t i = 0; i < numbers.size(); ++i) {
        // Of three candidates the second is sharp.
        const auto frame = choice.Offer(At(choice.stamps_s()[i], i % 3 != 1), i);
        if (frame) chosen_s.push_back(frame->stamp_s);
    }
    const auto last = choice.Last();
    ASSERT_TRUE(last);
    chosen_s.push_back(last->stamp_s);
    EXPECT_FALSE(choice.Last());
    // Stretches of six frames or, by rounding, five; the last may have fewer candidates.
    ASSERT_EQ(chosen_s.size(), (numbers.size() + 2) / 3);
    for (std::size_t i = 0; 3 * i + 1 < numbers.size(); ++i)
        EXPECT_EQ(chosen_s[i], choice.stamps_s()[3 * i + 1]) << i;
}

TEST(ViewChoice, ATurnIsAStretchToo) {
    std::vector<StampedPose> path;
    for (int i = 0; i <= 30; ++i)
        path.push_back({i / 30.0, *WallFrame({0, 0, -1}, 0.025 * i).T_world_camera});
    ViewChoice choice(path, WallCamera());
    int chosen = 0;
    for (std::size_t i = 0; i < choice.stamps_s().size(); ++i)
        chosen += choice.Offer(At(choice.stamps_s()[i]), i).has_value();
    EXPECT_EQ(chosen, 10);  // 0.75 rad
}

TEST(ViewChoice, ALongPathHasLongerStretches) {
    const auto path = Path(8000, [](int) { return 0.0; });
    const ViewChoice choice(path, WallCamera());
    EXPECT_LE(choice.stamps_s().size(), ViewChoice::kMostStretches * ViewChoice::kCandidates);
    EXPECT_GT(choice.stamps_s().size(), ViewChoice::kMostStretches * ViewChoice::kCandidates / 2);
    EXPECT_GT(choice.stamps_s().back(), 0.99 * path.back().stamp_s);
}

TEST(ViewChoice, APoseThatIsNotANumberEndsNothing) {
    auto path = Path(
        ViewChoice::kMostStretches + 100, [](int) { return 0.0; }, 0);
    for (std::size_t i = 1; i < path.size(); ++i)
        path[i].T_world_camera.translation().x() = std::numeric_limits<double>::quiet_NaN();
    EXPECT_LE(ViewChoice(path, WallCamera()).stamps_s().size(), ViewChoice::kCandidates);
}

TEST(ViewChoice, FindsAFrameByItsTime) {
    const ViewChoice choice(Path(3, [](int) { return 0.0; }), WallCamera());
    EXPECT_EQ(choice.Find(At(1 / 30.0 + 1e-6)), 1u);
    EXPECT_FALSE(choice.Find(At(1.5 / 30)));
    EXPECT_FALSE(choice.Find(At(3 / 30.0)));
}

}  // namespace
}  // namespace tessera
