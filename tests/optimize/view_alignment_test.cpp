#include "optimize/view_alignment.h"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>
#include <vector>

#include "optimize/overlaps.h"
#include "optimize/painted_corner.h"

namespace tessera {
namespace view_test {
namespace {

// From none and from plus and minus each axis.
class Starts : public testing::TestWithParam<int> {};

TEST_P(Starts, ExactViewsAreAlignedToATenthOfAPixel) {
    const Eigen::Isometry3d T_a_b = Moved(0.12, 0.2);
    Vector6d off = Vector6d::Zero();
    if (GetParam() > 0) {
        const int axis = (GetParam() - 1) / 2;
        off(axis) = (GetParam() % 2 == 0 ? 1 : -1) * (axis < 3 ? 0.04 : 0.08);
    }
    const DenseView a = ViewFrom(Eigen::Isometry3d::Identity()), b = ViewFrom(T_a_b);
    const ViewAlignment aligned = AlignViews(a, b, T_a_b * Se3Exp(off));
    ASSERT_TRUE(aligned.converged);
    EXPECT_LT((aligned.T_a_b.translation() - T_a_b.translation()).norm(), 0.002);
    EXPECT_LT(RotationAngle(aligned.T_a_b, T_a_b), 0.001);
    EXPECT_GT(aligned.overlap, 0.5);
    EXPECT_GT(aligned.fit, 0.8);
}
INSTANTIATE_TEST_SUITE_P(Thirteen, Starts, testing::Range(0, 13));

TEST(ViewAlignment, BothDirectionsAgree) {
    const Eigen::Isometry3d T_a_b = Moved(-0.1, 0.15);
    const DenseView a = ViewFrom(Eigen::Isometry3d::Identity()), b = ViewFrom(T_a_b);
    const ViewAlignment forth = AlignViews(a, b, T_a_b),
                        reverse = AlignViews(b, a, T_a_b.inverse());
    const Eigen::Isometry3d there = forth.T_a_b, back = reverse.T_a_b;
    EXPECT_LT((there * back).translation().norm(), 1e-4);
    EXPECT_LT(RotationAngle(there * back, Eigen::Isometry3d::Identity()), 1e-4);
    // A right increment x of T_a_b is the right increment -Ad(T_a_b) x of T_b_a.
    Matrix6d adjoint = Matrix6d::Zero();
    adjoint.topLeftCorner<3, 3>() = adjoint.bottomRightCorner<3, 3>() = there.linear();
    adjoint.bottomLeftCorner<3, 3>() = Skew(there.translation()) * there.linear();
    const Matrix6d moved = adjoint.transpose() * reverse.information * adjoint;
    EXPECT_LT((moved - forth.information).norm(), 0.02 * forth.information.norm());
}

// Only the paint shows how the camera moved along the wall; in the same light and in another.
TEST(ViewAlignment, PaintShowsWhatAWallLeavesOpen) {
    const Eigen::Isometry3d T_a_b = Moved(0.03, 0.06);
    const DenseView a = ViewFrom(Eigen::Isometry3d::Identity(), Scene::kPaintedWall);
    for (const double gain : {1.0, 0.6}) {
        const DenseView b = ViewFrom(T_a_b, Scene::kPaintedWall, gain);
        const ViewAlignment aligned = AlignViews(a, b, Eigen::Isometry3d::Identity());
        ASSERT_TRUE(aligned.converged) << gain;
        EXPECT_LT((aligned.T_a_b.translation() - T_a_b.translation()).norm(), 0.003) << gain;
        EXPECT_LT(RotationAngle(aligned.T_a_b, T_a_b), 0.0015) << gain;
    }
}

// Turning at 1.4 rad/s and moving at 0.4 m/s; colour 12 ms late, its rows read within 25 ms.
FrameMotion Fast(double sign) {
    FrameMotion motion;
    motion.twist_per_s << 0.5 * sign, 1.2 * sign, 0.5, 0.3 * sign, -0.2, 0.1;
    motion.colour_delay_s = 0.012;
    motion.colour_readout_s = 0.025;
    return motion;
}

TEST(ReducedView, ColourIsThatOfTheSurfaceWhenItsDepthWasMeasured) {
    const Eigen::Isometry3d T = Moved(0.1, 0.1);
    for (const Scene scene : {Scene::kCorner, Scene::kPaintedWall}) {
        const FrameMotion motion = Fast(1);
        const ReducedView still = ReducedFrom(T, scene, Paint);
        const PreparedFrame frame = FrameOf(T, scene, Paint, motion);
        const ReducedView moved = MakeReducedView(frame, kViewCamera, motion),
                          ignored = MakeReducedView(frame, kViewCamera, {});
        // A few are off: at the ball's edge, colour shows another surface than depth.
        int pixels = 0, outside = 0, off = 0, ignored_off = 0;
        for (std::size_t i = 0; i < still.depth.size(); ++i) {
            const auto difference = [&](const ReducedView& view) {
                return std::abs(int{view.luma.data()[i]} - int{still.luma.data()[i]});
            };
            pixels += still.depth.data()[i] > 0;
            ignored_off += still.depth.data()[i] > 0 && difference(ignored) > 2;
            if (moved.depth.data()[i] > 0) {
                EXPECT_EQ(moved.depth.data()[i], still.depth.data()[i]);
                off += difference(moved) > 2;
            } else {
                outside += still.depth.data()[i] > 0;
            }
        }
        EXPECT_LT(off, pixels / 100);
        EXPECT_LT(outside, pixels / 15);
        EXPECT_GT(outside, 0);
        EXPECT_GT(ignored_off, pixels / 3);
    }
}

TEST(ViewAlignment, ViewsOfAMovingCameraAreAlignedWhereDepthWasMeasured) {
    const Eigen::Isometry3d T_a_b = Moved(0.03, 0.06);
    const auto off_m = [&](bool known) {
        const auto view = [&](const Eigen::Isometry3d& T, double sign) {
            const FrameMotion motion = Fast(sign);
            return MakeDenseView(MakeReducedView(FrameOf(T, Scene::kPaintedWall, Paint, motion),
                                                 kViewCamera, known ? motion : FrameMotion()),
                                 kViewCamera);
        };
        const ViewAlignment aligned =
            AlignViews(view(Eigen::Isometry3d::Identity(), 1), view(T_a_b, -1), T_a_b);
        EXPECT_TRUE(aligned.converged);
        return (aligned.T_a_b.translation() - T_a_b.translation()).norm();
    };
    EXPECT_LT(off_m(true), 0.003);
    EXPECT_GT(off_m(false), 0.03);
}

// A bare wall determines its distance and two rotations, nothing else.
TEST(ViewAlignment, ABareWallLeavesThreeMotionsOpen) {
    const DenseView wall = ViewFrom(Eigen::Isometry3d::Identity(), Scene::kBareWall);
    const ViewAlignment aligned = AlignViews(wall, wall, Eigen::Isometry3d::Identity());
    const Matrix6d& I = aligned.information;
    EXPECT_GT(I(5, 5), 1e4);  // along the view
    EXPECT_LT(I(3, 3), 1e-3 * I(5, 5));
    EXPECT_LT(I(4, 4), 1e-3 * I(5, 5));
    EXPECT_LT(I(2, 2), 1e-3 * I(0, 0));
}

TEST(ViewAlignment, ViewsOfDifferentPlacesAreNotAligned) {
    const Eigen::Isometry3d away = Moved(0, 0) * Eigen::AngleAxisd(2.5, Eigen::Vector3d::UnitY());
    const DenseView here = ViewFrom(Eigen::Isometry3d::Identity());
    EXPECT_FALSE(AlignViews(here, ViewFrom(away), away).converged);
    EXPECT_FALSE(AlignViews(here, DenseView(), Moved(0, 0)).converged);
}

// A place that features propose is aligned from there, wherever the graph has the two keyframes.
TEST(OverlapFinder, AlignsFromThePoseThatItIsGiven) {
    const Eigen::Isometry3d T_a_b = Moved(0.12, 0.2);
    const Eigen::Isometry3d T_tracked = T_a_b * Eigen::Translation3d(1.5, 0, 0);
    std::vector<Keyframe> list(2);
    list[0].reduced = ReducedFrom(Eigen::Isometry3d::Identity());
    list[1].id = 1;
    list[1].reduced = ReducedFrom(T_a_b);
    list[1].T_map_camera = list[1].T_world_camera = T_tracked;
    Keyframes keyframes(kViewCamera, 0.8, 100);
    keyframes.Resume(std::move(list));
    OverlapFinder finder(kViewCamera);
    EXPECT_FALSE(finder.Align(keyframes, 1, 0, T_tracked, true));
    EXPECT_TRUE(keyframes[1].overlaps.empty());
    ASSERT_TRUE(finder.Align(keyframes, 1, 0, T_a_b * Se3Exp(Vector6d::Constant(0.02)), true));
    ASSERT_EQ(keyframes[1].overlaps.size(), 1u);
    const Overlap& overlap = keyframes[1].overlaps[0];
    EXPECT_EQ(overlap.with, 0);
    EXPECT_LT((overlap.T_with_this_aligned.translation() - T_a_b.translation()).norm(), 0.002);
    EXPECT_TRUE(overlap.T_with_this_tracked->isApprox(T_tracked, 1e-9));
}

}  // namespace
}  // namespace view_test
}  // namespace tessera
