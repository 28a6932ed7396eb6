#include "tracking/image_aligner.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "core/se3.h"
#include "support/box_room.h"
#include "tracking/image_search.h"

namespace tessera {
namespace {

using testing_support::BoxRoom;

PinholeCamera FullCamera() { return {640, 480, 525, 525, 319.5, 239.5}; }

PreparedFrame Prepare(const Frame& frame) {
    PreparedFrame prepared;
    PrepareFrame(frame, {}, prepared);
    return prepared;
}

class FromRest : public testing::TestWithParam<Vector6d> {};

TEST_P(FromRest, AFastMotionIsFound) {
    BoxRoom room;
    room.has_ball = true;
    const Vector6d twist = GetParam();
    ImageAligner aligner({}, FullCamera());
    aligner.Align(Prepare(room.Render(FullCamera(), Eigen::Isometry3d::Identity())),
                  Eigen::Isometry3d::Identity());
    const Eigen::Isometry3d T_true = Se3Exp(twist);
    const Eigen::Isometry3d T =
        aligner.Align(Prepare(room.Render(FullCamera(), T_true)), Eigen::Isometry3d::Identity());
    EXPECT_LT((T_true.inverse() * T).translation().norm(), 0.015);
    EXPECT_LT(RotationAngle(T_true, T), 0.01);
}
Vector6d Twist(double a, double b, double c, double d, double e, double f) {
    return (Vector6d() << a, b, c, d, e, f).finished();
}
INSTANTIATE_TEST_SUITE_P(ImageAligner, FromRest,
                         // 6.6 degrees and 7 cm between two frames.
                         testing::Values(Twist(0.06, -0.09, 0.05, 0.05, -0.03, 0.04),
                                         // 14 degrees, as at 400 degrees per second.
                                         Twist(0.01, 0.25, 0.02, 0.05, -0.02, 0.01),
                                         Twist(0.01, -0.25, 0.02, -0.05, 0.02, 0.01)));

// On a bare wall, noise says less about motion along the wall than the guess does.
TEST(ImageAligner, AlongABareWallKeepsTheGuess) {
    BoxRoom room;
    room.only_back_wall = true;
    room.texture = 0;
    std::mt19937 random(5);
    std::normal_distribution<float> noise;
    const auto noisy = [&](const Eigen::Isometry3d& T_world_camera) {
        Frame frame = room.Render(FullCamera(), T_world_camera);
        for (std::size_t i = 0; i < frame.depth_m.size(); ++i) {
            frame.depth_m.data()[i] += 0.0015f * noise(random);
            const float grey = static_cast<float>(frame.colour.data()[i].g) + 3.4f * noise(random);
            const auto level = static_cast<std::uint8_t>(std::clamp(grey, 0.0f, 255.0f));
            frame.colour.data()[i] = {level, level, level};
        }
        return Prepare(frame);
    };
    ImageAligner aligner({}, FullCamera());
    aligner.Align(noisy(Eigen::Isometry3d::Identity()), Eigen::Isometry3d::Identity());
    const Eigen::Isometry3d guess(Eigen::Translation3d(0.03, -0.02, 0.04)),
        T_true(Eigen::Translation3d(0, 0, 0.01));
    const Eigen::Isometry3d T = aligner.Align(noisy(T_true), guess);
    EXPECT_NEAR(T.translation().x(), 0.03, 0.002);
    EXPECT_NEAR(T.translation().y(), -0.02, 0.002);
    EXPECT_NEAR(T.translation().z(), 0.01, 0.005);
    EXPECT_LT(RotationAngle(T, T_true), 0.005);
}

TEST(ImageAligner, WithoutAnythingToAlignReturnsTheGuess) {
    Eigen::Isometry3d guess = Eigen::Isometry3d::Identity();
    guess.translation().x() = 0.1;
    Frame frame;
    frame.depth_m = DepthImage(640, 480, 0.0f);
    ImageAligner aligner({}, FullCamera());
    EXPECT_TRUE(aligner.Align(Prepare(frame), guess).isApprox(guess));
    EXPECT_TRUE(aligner.Align(Prepare(frame), guess).isApprox(guess, 1e-6));
}

// An object covers the camera while the camera moves. The next frame is aligned with the last frame
// before the object.
TEST(ImageAligner, AFrameThatIsNotKeptIsPassedOver) {
    BoxRoom room;
    room.has_ball = true;
    const PreparedFrame before = Prepare(room.Render(FullCamera(), Eigen::Isometry3d::Identity()));
    const Eigen::Isometry3d T_true = Se3Exp(Twist(0.02, -0.05, 0.02, 0.05, -0.03, 0.04));
    const PreparedFrame after = Prepare(room.Render(FullCamera(), T_true));
    Frame covered;
    covered.depth_m = DepthImage(640, 480, 0.5f);
    covered.colour = ColourImage(640, 480, {90, 60, 50});
    for (const bool saved : {false, true}) {
        ImageAligner aligner({}, FullCamera());
        aligner.Align(before, Eigen::Isometry3d::Identity());
        for (int i = 0; i < 2; ++i) {
            aligner.Align(Prepare(covered), Eigen::Isometry3d::Identity());
            aligner.KeepNewest(false);
        }
        ImageAligner next({}, FullCamera());
        if (saved) {
            std::vector<std::uint8_t> bytes;
            StateWriter writer(bytes);
            aligner.SaveState(writer);
            StateReader reader(bytes);
            ASSERT_TRUE(next.LoadState(reader));
        }
        const Eigen::Isometry3d T =
            (saved ? next : aligner).Align(after, Eigen::Isometry3d::Identity());
        EXPECT_LT((T_true.inverse() * T).translation().norm(), 0.015) << saved;
        EXPECT_LT(RotationAngle(T_true, T), 0.01) << saved;
    }
}

// A strip has few rows to reduce. At least two must remain, because interpolation needs two.
TEST(ImageAligner, AStripIsAlignedWithinItsImage) {
    const PinholeCamera camera{1024, 32, 800, 800, 511.5, 15.5};
    BoxRoom room;
    const Frame frame = room.Render(camera, Eigen::Isometry3d::Identity());
    const PreparedFrame prepared = Prepare(frame);
    for (const PreparedFrame::Reduced& reduced : prepared.reduced)
        EXPECT_EQ(reduced.depth_m.height(), 2);
    ImageAligner aligner({}, camera);
    aligner.Align(prepared, Eigen::Isometry3d::Identity());
    EXPECT_TRUE(aligner.Align(prepared, Eigen::Isometry3d::Identity())
                    .isApprox(Eigen::Isometry3d::Identity(), 1e-6));
}

TEST(ImageSearch, FindsAShiftToThePixelAndItsSign) {
    const PinholeCamera camera{40, 30, 32.8, 32.8, 19.5, 14.5};
    Image<float> last(40, 30), current(40, 30);
    const auto texture = [](int x, int y) {
        return 0.5f + 0.3f * static_cast<float>(std::sin(0.7 * x) * std::cos(0.9 * y + 0.2 * x));
    };
    for (int y = 0; y < 30; ++y)
        for (int x = 0; x < 40; ++x) {
            last(x, y) = texture(x, y);
            // The content moved by (+3, -2) and got brighter.
            current(x, y) = 0.1f + texture(x - 3, y + 2);
        }
    const auto rotations = SearchRotations(last, current, camera, 1);
    ASSERT_EQ(rotations.size(), 1u);
    // A rotation from the last to the current camera coordinates moves the image right and up.
    const Eigen::Vector3d p =
        Se3Exp((Vector6d() << rotations[0], Eigen::Vector3d::Zero()).finished()) *
        camera.Unproject(19.5, 14.5, 1.0);
    EXPECT_NEAR(camera.Project(p).x(), 22.5, 0.1);
    EXPECT_NEAR(camera.Project(p).y(), 12.5, 0.1);
}

}  // namespace
}  // namespace tessera
