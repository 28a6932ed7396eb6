#include "synth/shape.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "synth/hash_random.h"

namespace tessera {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

Shape Make(ShapeKind kind, const Vector3d& half) { return {kind, half}; }
const Shape kBox = Make(ShapeKind::kBox, {0.5, 1.0, 1.5});
const Shape kSphere = Make(ShapeKind::kSphere, {0.7, 0.7, 0.7});
const Shape kCylinder = Make(ShapeKind::kCylinder, {0.4, 0.4, 1.2});
const Shape kRectangle = Make(ShapeKind::kRectangle, {0.8, 0.6, 0.0});
const Shape kAll[] = {kBox, kSphere, kCylinder, kRectangle};

Vector3d Direction(std::uint64_t i) {
    const auto gauss = [i](std::uint64_t k) {
        return static_cast<double>(GaussianFromBits(MixBits(3 * i + k)));
    };
    return Vector3d(gauss(0), gauss(1), gauss(2)).normalized();
}

TEST(Shape, RaysMeetEachBodyAtTheClosedFormsDistance) {
    const Vector3d along_x(1, 0, 0), along_z(0, 0, 1);
    EXPECT_DOUBLE_EQ(Intersect(kBox, {-3, 0.2, 0.1}, along_x, 1e9)->t, 2.5);
    EXPECT_DOUBLE_EQ(Intersect(kBox, {-3, 0.2, 0.1}, 2 * along_x, 1e9)->t, 1.25);
    // A sphere at height h: x = sqrt(r^2 - h^2).
    EXPECT_NEAR(Intersect(kSphere, {-3, 0.3, 0}, along_x, 1e9)->t, 3 - std::sqrt(0.49 - 0.09),
                1e-14);
    EXPECT_NEAR(Intersect(kCylinder, {-3, 0.24, 1.1}, along_x, 1e9)->t, 3 - 0.32, 1e-14);
    EXPECT_NEAR(Intersect(kCylinder, {0.1, 0.1, -5}, along_z, 1e9)->t, 5 - 1.2, 1e-14);
    EXPECT_NEAR(Intersect(kRectangle, {0.7, -0.5, -2}, along_z, 1e9)->t, 2.0, 1e-14);
}

TEST(Shape, RaysThatPassBesideOrTheOtherWayMeetNothing) {
    const Vector3d along_x(1, 0, 0), along_z(0, 0, 1);
    EXPECT_FALSE(Intersect(kBox, {-3, 1.01, 0}, along_x, 1e9));
    EXPECT_FALSE(Intersect(kBox, {-3, 0, 0}, -along_x, 1e9));
    EXPECT_FALSE(Intersect(kSphere, {-3, 0.701, 0}, along_x, 1e9));
    EXPECT_FALSE(Intersect(kCylinder, {-3, 0, 1.21}, along_x, 1e9));
    EXPECT_FALSE(Intersect(kCylinder, {0.3, 0.3, -5}, along_z, 1e9));
    EXPECT_FALSE(Intersect(kRectangle, {0.81, 0, -2}, along_z, 1e9));
    EXPECT_FALSE(Intersect(kRectangle, {0, 0, -2}, along_x, 1e9));
    EXPECT_FALSE(Intersect(kBox, {-3, 0, 0}, along_x, 2.4));  // farther than t_max
}

TEST(Shape, AHitLiesOnTheSurfaceAndNothingIsInFrontOfIt) {
    for (const Shape& shape : kAll) {
        int hits = 0;
        for (std::uint64_t i = 0; i < 2000; ++i) {
            const Vector3d origin = 4 * Direction(i);
            const Vector3d direction = (0.8 * Direction(i + 5000) - origin).normalized();
            const auto hit = Intersect(shape, origin, direction, 1e9);
            const double until = hit ? hit->t : 8.0;
            // Sphere tracing along the exact distance never passes the surface, which gives an
            // independent reference.
            double t = 0, distance = 1;
            while (t < 8.0 && distance > 1e-9)
                t += distance = SignedDistance(shape, origin + t * direction);
            if (hit) {
                ++hits;
                EXPECT_NEAR(SignedDistance(shape, origin + hit->t * direction), 0, 1e-12);
                EXPECT_NEAR(t, until, 1e-5);
            } else {
                EXPECT_GE(t, 8.0);
            }
        }
        EXPECT_GT(hits, 500);
    }
}

TEST(Shape, ChartsAndPointsAreInverseAndNormalsAreTheDistancesGradient) {
    for (const Shape& shape : kAll) {
        for (int chart = 0; chart < ChartCount(shape.kind); ++chart) {
            const Vector2d size = ChartSize(shape, chart);
            for (int i = 1; i < 10; ++i) {
                // Inside a cylinder's cap, a disc within its square.
                const Vector2d uv(size.x() * (0.2 + 0.06 * i), size.y() * (0.75 - 0.05 * i));
                const Vector3d p = PointOnChart(shape, chart, uv);
                EXPECT_NEAR((ChartPoint(shape, chart, p) - uv).norm(), 0, 1e-12);
                EXPECT_NEAR(SignedDistance(shape, p), 0, 1e-12);
                const Vector3d normal = NormalOnChart(shape, chart, p);
                EXPECT_NEAR(normal.norm(), 1, 1e-12);
                EXPECT_NEAR(AlongNormal(shape, chart, p, Vector3d(1, 2, 3)),
                            normal.dot(Vector3d(1, 2, 3)), 1e-12);
                EXPECT_NEAR(SignedDistance(shape, p + 0.01 * normal), 0.01, 1e-9);
                // u points right and v down when seen from outside, so u x v points inwards.
                const double h = 1e-6;
                const Vector3d du = PointOnChart(shape, chart, uv + Vector2d(h, 0)) - p;
                const Vector3d dv = PointOnChart(shape, chart, uv + Vector2d(0, h)) - p;
                EXPECT_LT(du.cross(dv).normalized().dot(normal), -0.999);
            }
        }
    }
}

TEST(Shape, DistancesInsideAndOutside) {
    EXPECT_DOUBLE_EQ(SignedDistance(kBox, {0, 0, 0}), -0.5);
    EXPECT_DOUBLE_EQ(SignedDistance(kBox, {3.5, 5.0, 1.0}), 5.0);  // 3-4-5 from the edge
    EXPECT_NEAR(SignedDistance(kSphere, {0, 0, 2}), 1.3, 1e-15);
    EXPECT_NEAR(SignedDistance(kCylinder, {3.4, 0, 5.2}), 5.0, 1e-14);
    EXPECT_NEAR(SignedDistance(kCylinder, {0.1, 0, 0}), -0.3, 1e-15);
    EXPECT_DOUBLE_EQ(SignedDistance(kRectangle, {0, 0, -2}), 2.0);
}

TEST(Shape, ARayInsideABodyMeetsItsFarSide) {
    EXPECT_DOUBLE_EQ(Intersect(kBox, {0, 0, 0}, {0, 1, 0}, 1e9)->t, 1.0);
    EXPECT_EQ(Intersect(kBox, {0, 0, 0}, {0, 1, 0}, 1e9)->chart, 3);
    EXPECT_NEAR(Intersect(kSphere, {0.2, 0, 0}, {1, 0, 0}, 1e9)->t, 0.5, 1e-15);
}

}  // namespace
}  // namespace tessera
