#include "viz/surface_bounds.h"

#include <gtest/gtest.h>

#include "optimize/scan_parts.h"

namespace tessera {
namespace {

using Eigen::Vector3d;

// A block of 1 m whose lowest corner is there.
Eigen::AlignedBox3d BlockAt(double x, double y, double z) {
    return {Vector3d(x, y, z), Vector3d(x + 1, y + 1, z + 1)};
}

TEST(SurfaceBounds, OfAllAndOfThePartAroundAPoint) {
    SurfaceBounds bounds;
    EXPECT_TRUE(bounds.All().isEmpty());
    EXPECT_TRUE(bounds.Around(Vector3d(0, 0, 0)).isEmpty());
    for (int x = -120; x <= 120; ++x) bounds.Extend(BlockAt(x, 0, 0));
    const double other = PartStart(1).translation().x();
    bounds.Extend(BlockAt(other, 2, -3));
    EXPECT_EQ(bounds.All().min(), Vector3d(-120, 0, -3));
    EXPECT_EQ(bounds.All().max(), Vector3d(other + 1, 3, 1));
    const Eigen::AlignedBox3d first = bounds.Around(Vector3d(100, 0, 0));
    EXPECT_EQ(first.min(), Vector3d(-120, 0, 0));
    EXPECT_EQ(first.max(), Vector3d(121, 1, 1));
    const Eigen::AlignedBox3d second = bounds.Around(Vector3d(other + 5, 0, 0));
    EXPECT_EQ(second.min(), Vector3d(other, 2, -3));
    EXPECT_EQ(second.max(), Vector3d(other + 1, 3, -2));
    EXPECT_EQ(bounds.Around(std::nullopt).max(), bounds.All().max());
    // A part that is gone, because it was joined with another.
    EXPECT_EQ(bounds.Around(Vector3d(0, 0, 4000)).max(), bounds.All().max());
}

}  // namespace
}  // namespace tessera
