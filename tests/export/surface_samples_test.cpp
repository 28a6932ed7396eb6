#include "export/surface_samples.h"

#include <gtest/gtest.h>

#include "mapping/analytic_fields.h"

namespace tessera {
namespace {

using testing_support::Uniform;

// One block, which holds a piece of a plane: known from voxel 0 to voxel 7 along each axis.
class SurfaceSamples : public ::testing::Test {
  protected:
    static constexpr double kVoxel_m = 0.02;

    SurfaceSamples() {
        testing_support::FillBlock(map, map.Allocate({-1, 2, 0}), plane, nullptr, 1);
    }
    CellGrid Grid(double resolution_m) const {
        const Eigen::AlignedBox3d box(Eigen::Vector3d(-1, -1, -1), Eigen::Vector3d(1, 1, 1));
        return MakeGrid(box, resolution_m, Eigen::Isometry3d::Identity()).value();
    }

    const Eigen::Vector3d normal = Eigen::Vector3d(1, 2, 4).normalized();
    const Eigen::Vector3d low{-8 * kVoxel_m, 16 * kVoxel_m, 0};
    const testing_support::Sdf plane =
        testing_support::Plane(normal, normal.dot(low + Eigen::Vector3d::Constant(3.6 * kVoxel_m)));
    BlockMap map{BlockMap::Config{.voxel_size_m = kVoxel_m, .truncation_m = 0.2}};
};

TEST_F(SurfaceSamples, TheyCoverTheSurfaceUpToTheEndOfWhatIsKnown) {
    struct Case {
        double resolution_m, gap_voxels;
    };
    for (const Case& c : {Case{0.05, 0.75}, {0.02, 0.375}, {0.005, 0.095}}) {
        const CellGrid grid = Grid(c.resolution_m);
        std::vector<Eigen::Vector3d> points;
        for (const Eigen::Vector3f& cells : SurfacePoints(map, grid, 1)) {
            points.emplace_back(grid.Low() + c.resolution_m * cells.cast<double>());
            ASSERT_NEAR(plane(points.back()), 0, 2e-5);
        }
        for (std::uint32_t i = 0, done = 0; done < 1000; ++i) {
            Eigen::Vector3d p(Uniform(3 * i), Uniform(3 * i + 1), Uniform(3 * i + 2));
            p = low + 7 * kVoxel_m * p;
            p -= plane(p) * normal;
            if (((p - low).array() < 0).any() || ((p - low).array() > 7 * kVoxel_m).any()) continue;
            ++done;
            double nearest_m = 1;
            for (const Eigen::Vector3d& point : points)
                nearest_m = std::min(nearest_m, (point - p).norm());
            ASSERT_LT(nearest_m / kVoxel_m, c.gap_voxels) << p.transpose();
        }
    }
}

TEST_F(SurfaceSamples, WeightAndOcclusionEdgesAreTheMeshers) {
    EXPECT_FALSE(SurfacePoints(map, Grid(0.05), 1).empty());
    EXPECT_TRUE(SurfacePoints(map, Grid(0.05), 1.1).empty());
    for (int i = 0; i < kBlockVoxels; ++i)  // falls over the whole range at once
        map.field(1)[i] = testing_support::PackField(FieldDistance(map.field(1)[i]) < 0 ? -1 : 1);
    EXPECT_TRUE(SurfacePoints(map, Grid(0.05), 1).empty());
}

TEST_F(SurfaceSamples, SidesAreKnownWhereAllVoxelsAroundAre) {
    const CellGrid grid = Grid(0.01);
    const std::vector<std::int8_t> sides = ObservedSides(map, grid);
    for (int z = 0; z < grid.size.z(); ++z)
        for (int y = 0; y < grid.size.y(); ++y)
            for (int x = 0; x < grid.size.x(); ++x) {
                const Eigen::Vector3d p = grid.Centre(x, y, z), at = (p - low) / kVoxel_m;
                const bool known = at.minCoeff() >= 0 && at.maxCoeff() <= 7;
                const int expected = !known ? 0 : plane(p) < 0 ? -1 : 1;
                ASSERT_EQ(sides[grid.Index(x, y, z)], expected) << at.transpose();
            }
}

}  // namespace
}  // namespace tessera
