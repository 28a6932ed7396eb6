#include "optimize/view_alignment.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "optimize/overlaps.h"
#include "optimize/texture_correlation.h"

namespace tessera {
namespace {

const PinholeCamera kViewCamera{640, 480, 525, 525, 319.5, 239.5};

// A room's corner with a ball in it, painted with smooth waves; exact. World: the first camera.
double DepthAlong(const Eigen::Vector3d& from, const Eigen::Vector3d& along) {
    double nearest = 1e9;
    const auto plane = [&](const Eigen::Vector3d& normal, double offset) {
        const double t = (offset - normal.dot(from)) / normal.dot(along);
        if (t > 0) nearest = std::min(nearest, t);
    };
    plane({0, 0, 1}, 2.5);
    plane({1, 0, 0.2}, 1.6);
    plane({0, 1, 0.1}, 1.2);
    const Eigen::Vector3d to_ball = from - Eigen::Vector3d(-0.3, 0.1, 1.9);
    const double b = to_ball.dot(along), c = to_ball.squaredNorm() - 0.35 * 0.35;
    const double a = along.squaredNorm(), root = b * b - a * c;
    if (root > 0) nearest = std::min(nearest, (-b - std::sqrt(root)) / a);
    return nearest;
}

double Paint(const Eigen::Vector3d& p) {
    return 0.5 + 0.2 * std::sin(9 * p.x() + 3 * p.z()) + 0.2 * std::sin(8 * p.y() - 2 * p.x());
}

// The walls are the far one only.
enum class Scene { kCorner, kBareWall, kPaintedWall };

// A frame of a camera that moves: each row of colour is of its own time.
PreparedFrame FrameOf(const Eigen::Isometry3d& T_world_camera, Scene scene,
                      const std::function<double(const Eigen::Vector3d&)>& paint,
                      const FrameMotion& motion) {
    PreparedFrame frame;
    frame.width = kViewCamera.width;
    frame.height = kViewCamera.height;
    frame.has_colour = true;
    frame.depth_m.Resize(frame.width, frame.height);
    frame.intensity.Resize(frame.width, frame.height);
    struct Hit {
        double z;
        Eigen::Vector3d p_world;
    };
    const auto hit = [&](const Eigen::Isometry3d& T, int x, int y) {
        const Eigen::Vector3d ray = T.linear() * kViewCamera.Unproject(x, y, 1);
        const Eigen::Vector3d eye = T.translation();
        const double z = scene == Scene::kCorner ? DepthAlong(eye, ray) : (2.5 - eye.z()) / ray.z();
        return Hit{z, eye + z * ray};
    };
    const bool still = motion.twist_per_s.isZero();
    for (int y = 0; y < frame.height; ++y) {
        const Eigen::Isometry3d T_world_colour =
            T_world_camera * Se3Exp(motion.ColourTime(y, frame.height) * motion.twist_per_s);
        for (int x = 0; x < frame.width; ++x) {
            const Hit measured = hit(T_world_camera, x, y),
                      seen = still ? measured : hit(T_world_colour, x, y);
            frame.depth_m(x, y) = static_cast<float>(measured.z);
            frame.intensity(x, y) =
                static_cast<float>(scene == Scene::kBareWall ? 0.5 : paint(seen.p_world));
        }
    }
    return frame;
}

ReducedView ReducedFrom(const Eigen::Isometry3d& T_world_camera, Scene scene,
                        const std::function<double(const Eigen::Vector3d&)>& paint) {
    return MakeReducedView(FrameOf(T_world_camera, scene, paint, {}), kViewCamera, {});
}

// `gain`: of the light.
ReducedView ReducedFrom(const Eigen::Isometry3d& T_world_camera, Scene scene = Scene::kCorner,
                        double gain = 1) {
    return ReducedFrom(T_world_camera, scene,
                       [=](const Eigen::Vector3d& p) { return gain * Paint(p); });
}

DenseView ViewOf(const Eigen::Isometry3d& T_world_camera,
                 const std::function<double(const Eigen::Vector3d&)>& paint) {
    return MakeDenseView(ReducedFrom(T_world_camera, Scene::kCorner, paint), kViewCamera);
}

DenseView ViewFrom(const Eigen::Isometry3d& T_world_camera, Scene scene = Scene::kCorner,
                   double gain = 1) {
    return MakeDenseView(ReducedFrom(T_world_camera, scene, gain), kViewCamera);
}

Eigen::Isometry3d Moved(double turn, double shift) {
    Vector6d twist;
    twist << 0.3 * turn, turn, -0.2 * turn, shift, 0.4 * shift, -0.5 * shift;
    return Se3Exp(twist);
}

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

// In another light, which falls off to one side, the same paint correlates; other paint on the same
// walls does not.
TEST(TextureCorrelation, TellsPaintFromLight) {
    const auto painted = [](const Eigen::Isometry3d& T_world_camera, unsigned seed,
                            double fall_off) {
        // Patches of 4 cm, each of one shade.
        return ViewOf(T_world_camera, [=](const Eigen::Vector3d& p) {
            const auto cell = [](double v) {
                return static_cast<unsigned>(static_cast<std::int64_t>(std::floor(25 * v)) + 500);
            };
            const unsigned shade = (cell(p.x()) * 73856093u ^ cell(p.y()) * 19349663u ^
                                    cell(p.z()) * 83492791u ^ seed) *
                                   2654435761u;
            return (0.3 + 0.4 * (shade >> 16 & 255) / 255.0) * (0.9 - fall_off * p.x());
        });
    };
    const Eigen::Isometry3d T_a_b = Moved(0.05, 0.1);
    const DenseView a = painted(Eigen::Isometry3d::Identity(), 1, 0);
    EXPECT_GT(TextureCorrelation(a, painted(T_a_b, 1, 0), T_a_b), 0.85);
    EXPECT_GT(TextureCorrelation(a, painted(T_a_b, 1, 0.25), T_a_b), 0.85);
    EXPECT_LT(std::abs(TextureCorrelation(a, painted(T_a_b, 2, 0), T_a_b)), 0.2);
    const Eigen::Isometry3d away = Moved(0, 0) * Eigen::AngleAxisd(2.5, Eigen::Vector3d::UnitY());
    EXPECT_EQ(TextureCorrelation(a, painted(away, 1, 0), away), 0);
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
}  // namespace tessera
