#include "export/distance_field.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <cstdlib>
#include <cstring>

#include "core/input_file.h"
#include "export/nearest_points.h"
#include "mapping/analytic_fields.h"
#include "support/temp_folder.h"

namespace tessera {
namespace {

using testing_support::Uniform;

// Shapes that do not touch: the distance to their surface is exact inside and outside. Voxels
// would cut edges that are not round.
testing_support::Sdf Shapes() {
    using testing_support::Union;
    const testing_support::Sdf core = testing_support::Box({0.5, -0.4, 0}, {0.2, 0.02, 0.3});
    return Union(Union(testing_support::Sphere({-0.5, 0.1, 0.1}, 0.3),
                       [=](const Eigen::Vector3d& p) { return core(p) - 0.12; }),
                 testing_support::Torus({0.3, 0.5, -0.2}, 0.25, 0.12));
}

class DistanceFields : public ::testing::Test {
  protected:
    static constexpr double kVoxel_m = 0.02, kTruncation_m = 0.06;

    DistanceFields() {
        testing_support::Fill(map, sdf, {-8, -8, -8}, {8, 8, 8});
        T_world_grid.rotate(Eigen::AngleAxisd(0.4, Eigen::Vector3d(3, 1, -2).normalized()));
        T_world_grid.translation() << 0.1, 0.05, -0.2;
    }

    CellGrid Grid(double low_m, double high_m, double resolution_m) const {
        const Eigen::Vector3d one = Eigen::Vector3d::Ones();
        return MakeGrid({low_m * one, high_m * one}, resolution_m, T_world_grid).value();
    }
    double Truth(const DistanceField& field, int x, int y, int z) const {
        return sdf(T_world_grid * field.grid.Centre(x, y, z));
    }
    template <class Visit>
    static void ForEachCell(const CellGrid& grid, const Visit& visit) {
        for (int z = 0; z < grid.size.z(); ++z)
            for (int y = 0; y < grid.size.y(); ++y)
                for (int x = 0; x < grid.size.x(); ++x) visit(x, y, z);
    }

    const testing_support::Sdf sdf = Shapes();
    BlockMap map{BlockMap::Config{.voxel_size_m = kVoxel_m, .truncation_m = kTruncation_m}};
    Eigen::Isometry3d T_world_grid = Eigen::Isometry3d::Identity();
};

// Coarser than the voxels, as fine, and finer. 100,000 cells or more each.
TEST_F(DistanceFields, EveryCellIsWithinHalfACellOfTheTruth) {
    struct Case {
        double low_m, high_m, resolution_m;
    };
    for (const Case& c :
         {Case{-1.2, 1.2, 0.05}, {-0.5, 0.5, 0.02}, {-0.3, 0.2, 0.01}, {-0.3, -0.05, 0.005}}) {
        const CellGrid grid = Grid(c.low_m, c.high_m, c.resolution_m);
        ASSERT_GE(grid.cells(), 100000u);
        const Result<DistanceField> made =
            MakeDistanceField(map, grid, {.max_distance_m = 100 * c.resolution_m});
        ASSERT_TRUE(made.ok()) << made.message();
        const DistanceField& field = made.value();
        double worst = 0, sum = 0;
        ForEachCell(grid, [&](int x, int y, int z) {
            const double error =
                std::abs(std::abs(field.At(x, y, z)) -
                         std::min(100 * c.resolution_m, std::abs(Truth(field, x, y, z))));
            worst = std::max(worst, error / c.resolution_m);
            sum += error / c.resolution_m;
        });
        EXPECT_LT(sum / static_cast<double>(grid.cells()), 0.07) << c.resolution_m;
        EXPECT_LT(worst, 0.5) << c.resolution_m;
    }
}

// Between the centres, by trilinear interpolation, at 100,000 random points in front of surfaces.
TEST_F(DistanceFields, InterpolationBetweenCentresIsWithinHalfACell) {
    const Result<DistanceField> made = MakeDistanceField(map, Grid(-1.0, 1.0, 0.05), {});
    ASSERT_TRUE(made.ok()) << made.message();
    const DistanceField& field = made.value();
    double worst = 0;
    std::uint32_t counter = 1;
    for (int done = 0; done < 100000; counter += 3) {
        const Eigen::Vector3d cells =
            Eigen::Vector3d(Uniform(counter), Uniform(counter + 1), Uniform(counter + 2)) * 39;
        const double truth = sdf(T_world_grid * (field.grid.Centre(0, 0, 0) + 0.05 * cells));
        if (truth < 0) continue;
        ++done;
        const Eigen::Vector3i at = cells.cast<int>();
        const Eigen::Vector3d f = cells - at.cast<double>();
        double value = 0;
        for (int c = 0; c < 8; ++c) {
            const Eigen::Vector3i side(c & 1, c >> 1 & 1, c >> 2);
            double weight = 1;
            for (int k = 0; k < 3; ++k) weight *= side(k) != 0 ? f(k) : 1 - f(k);
            const Eigen::Vector3i p = at + side;
            value += weight * static_cast<double>(field.At(p.x(), p.y(), p.z()));
        }
        worst = std::max(worst, std::abs(value - truth));
    }
    EXPECT_LT(worst, 0.5 * 0.05);
}

TEST_F(DistanceFields, TheSignIsTheMapsAndUnknownSpaceIsMarked) {
    const DistanceField field = MakeDistanceField(map, Grid(-1.0, 1.0, 0.05), {}).value();
    int behind = 0, front = 0, unknown = 0;
    ForEachCell(field.grid, [&](int x, int y, int z) {
        const double truth = Truth(field, x, y, z);
        const bool known = field.Known(x, y, z);
        ASSERT_TRUE(known || std::abs(truth) >= kTruncation_m);
        ASSERT_TRUE(known || field.At(x, y, z) > 0);
        if (known && std::abs(truth) > 0.1 * kVoxel_m) {
            ASSERT_EQ(field.At(x, y, z) < 0, truth < 0) << truth;
        }
        behind += known && truth < 0;
        front += known && truth > 0;
        unknown += !known;
    });
    EXPECT_GT(behind, 500);
    EXPECT_GT(front, 2000);
    EXPECT_GT(unknown, 10000);
}

TEST_F(DistanceFields, SurfacesOutsideOfTheBoxCountUpToTheMaximum) {
    const CellGrid grid = Grid(0.9, 1.2, 0.05);  // no surface within
    for (const double most_m : {0.4, 0.7, 3.0}) {
        const DistanceField field =
            MakeDistanceField(map, grid, {.max_distance_m = most_m}).value();
        int capped = 0;
        ForEachCell(grid, [&](int x, int y, int z) {
            const double truth = std::min(most_m, Truth(field, x, y, z));
            ASSERT_GT(truth, 0.3);
            ASSERT_NEAR(field.At(x, y, z), truth, 0.4 * 0.05);
            ASSERT_LE(field.At(x, y, z), static_cast<float>(most_m));
            capped += truth == most_m;
        });
        EXPECT_EQ(capped > 0, most_m < 1);
    }
    const BlockMap empty(map.config());
    const DistanceField nothing = MakeDistanceField(empty, grid, {}).value();
    for (const float distance_m : nothing.distance_m) ASSERT_FLOAT_EQ(distance_m, 2);
}

TEST_F(DistanceFields, FreeSpaceThatWasSeenIsKnown) {
    const CellGrid grid = Grid(0.9, 1.2, 0.05);
    Occupancy seen{grid, std::vector<CellState>(grid.cells(), CellState::kUnknown)};
    seen.cells[7] = CellState::kFree;
    const DistanceField field = MakeDistanceField(map, grid, {}, &seen).value();
    for (std::size_t i = 0; i < field.known.size(); ++i) ASSERT_EQ(field.known[i], i == 7);
}

TEST_F(DistanceFields, EveryNumberOfThreadsGivesTheSameBytes) {
    const CellGrid grid = Grid(-1.0, 1.0, 0.04);
    const DistanceField any = MakeDistanceField(map, grid, {}).value();
    for (const std::size_t threads : {1, 4}) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
        const DistanceField field = MakeDistanceField(map, grid, {}).value();
        EXPECT_TRUE(field.distance_m == any.distance_m && field.known == any.known) << threads;
    }
}

TEST_F(DistanceFields, HostileRequestsAreRefusedWithAdvice) {
    const CellGrid grid = Grid(0.9, 1.2, 0.05);
    for (const double most_m : {0.0, -1.0, 1e9, std::nan("")})
        EXPECT_NE(MakeDistanceField(map, grid, {.max_distance_m = most_m}).message().find("1000 m"),
                  std::string::npos);
    EXPECT_NE(MakeDistanceField(map, grid, {.max_distance_m = 900})
                  .message()
                  .find("a smaller maximum distance"),
              std::string::npos);
    EXPECT_NE(MakeDistanceField(map, Grid(0, 0.1, 0.004), {}).message().find("at least 0.005 m"),
              std::string::npos);
}

TEST(NearestPoints, UnorderedPointsAgreeWithBruteForce) {
    // One point in each of some cells, beyond the box as well.
    const Eigen::Vector3i first(5, 3, 4), size(20, 25, 15);
    std::vector<Eigen::Vector3f> points;
    for (std::uint32_t i = 0; i < 300; ++i)
        points.emplace_back(35 * Uniform(9000 + 3 * i), 32 * Uniform(9001 + 3 * i),
                            22 * Uniform(9002 + 3 * i));
    const std::vector<float> found = NearestPoints(points, first, size, 100);
    double worst = 0;
    std::size_t at = 0;
    for (int z = 0; z < size.z(); ++z)
        for (int y = 0; y < size.y(); ++y)
            for (int x = 0; x < size.x(); ++x, ++at) {
                const Eigen::Vector3f centre =
                    (first + Eigen::Vector3i(x, y, z)).cast<float>().array() + 0.5f;
                float nearest = 100;
                for (const Eigen::Vector3f& p : points)
                    nearest = std::min(nearest, (p - centre).norm());
                ASSERT_GE(found[at], nearest - 1e-4f);
                worst = std::max(worst, static_cast<double>(found[at] - nearest));
            }
    EXPECT_LT(worst, 0.2);
}

TEST_F(DistanceFields, NumpyReadsTheFile) {
    const TempFolder folder;
    CellGrid grid = Grid(0.9, 1.2, 0.05);
    grid.size = {3, 2, 4};
    DistanceField field = MakeDistanceField(map, grid, {}).value();
    field.distance_m[grid.Index(2, 1, 3)] = -0.25f;
    field.known[grid.Index(1, 0, 2)] = 1;
    ASSERT_TRUE(WriteDistanceField(folder / "a.npy", field, "level").ok());
    const std::string bytes = ReadWholeFile(folder / "a.npy", 1 << 20).value();
    ASSERT_EQ(bytes.size() % 32, 0u);
    EXPECT_EQ(bytes.substr(0, 8), std::string("\x93NUMPY\x01\0", 8));
    EXPECT_NE(bytes.find("'descr': '<f4', 'fortran_order': False, 'shape': (4, 2, 3)"),
              std::string::npos);
    EXPECT_EQ(std::memcmp(bytes.data() + bytes.size() - 96, field.distance_m.data(), 96), 0);
    const std::string yaml = ReadWholeFile(folder / "a.yaml", 1 << 20).value();
    for (const char* line :
         {"distance: a.npy\n", "known: a_known.npy\n", "shape: [4, 2, 3]", "resolution: 0.05\n",
          "origin: [0.925, 0.925, 0.925]\n", "max_distance: 2\n", "frame: level\n"})
        EXPECT_NE(yaml.find(line), std::string::npos) << line << yaml;
    EXPECT_NE(
        WriteDistanceField(folder / "none/a.npy", field, "level").message().find("none/a.npy"),
        std::string::npos);
    if (std::system("python3 -c 'import numpy' 2>/dev/null") != 0) GTEST_SKIP() << "needs numpy";
    const std::string check =
        "python3 -c \"import numpy as n; d = n.load('" + (folder / "a.npy") + "'); k = n.load('" +
        (folder / "a_known.npy") +
        "'); assert d.shape == k.shape == (4, 2, 3) and d[3, 1, 2] == -0.25 and k[2, 0, 1] == 1 "
        "and k.sum() == 1\"";
    EXPECT_EQ(std::system(check.c_str()), 0);
}

}  // namespace
}  // namespace tessera
