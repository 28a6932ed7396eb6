#include "export/vdb_writer.h"

#include <gtest/gtest.h>
#include <openvdb/openvdb.h>

#include <cstdlib>
#include <filesystem>

#include "core/input_file.h"
#include "mapping/analytic_fields.h"
#include "support/temp_folder.h"

namespace tessera {
namespace {

constexpr double kVoxel_m = 0.02, kTruncation_m = 0.05;

Eigen::Vector3d Paint(const Eigen::Vector3d& p) {
    return {0.5 + 0.4 * p.x(), 0.5 - 0.3 * p.y(), 0.4 + 0.5 * p.z()};
}

double Linear(double s) { return s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4); }

class VdbWriter : public ::testing::Test {
  protected:
    VdbWriter() { testing_support::Fill(map, sdf, {-4, -4, -4}, {4, 4, 4}, Paint); }

    // Reads the grid `name` from the file.
    openvdb::GridBase::Ptr Read(const std::string& name) const {
        openvdb::initialize();
        openvdb::io::File file(path);
        file.open();
        return file.readGrid(name);
    }

    const testing_support::Sdf sdf = testing_support::Sphere({-0.05, 0.02, 0.11}, 0.3);
    BlockMap map{BlockMap::Config{.voxel_size_m = kVoxel_m, .truncation_m = kTruncation_m}};
    TempFolder folder;
    const std::string path = folder / "a.vdb";
};

TEST_F(VdbWriter, TheSurfaceIsTheMapsDistanceEverywhere) {
    ASSERT_TRUE(VdbAvailable());
    const Status status = WriteVdb(path, map);
    ASSERT_TRUE(status.ok()) << status.message();
    const auto grid = openvdb::gridPtrCast<openvdb::FloatGrid>(Read("surface"));
    ASSERT_TRUE(grid);
    EXPECT_EQ(grid->getGridClass(), openvdb::GRID_LEVEL_SET);
    EXPECT_FLOAT_EQ(grid->background(), static_cast<float>(kTruncation_m));
    EXPECT_EQ(grid->transform().voxelSize(), openvdb::Vec3d(kVoxel_m));
    int active = 0, inside = 0;
    for (int x = -36; x < 44; ++x)
        for (int y = -36; y < 44; ++y)
            for (int z = -36; z < 44; ++z) {
                const openvdb::Vec3d world =
                    grid->transform().indexToWorld(openvdb::Coord(x, y, z));
                const double distance_m = sdf({world.x(), world.y(), world.z()});
                const float value = grid->tree().getValue({x, y, z});
                const bool in_band = std::abs(distance_m) < kTruncation_m * 0.9999;
                ASSERT_EQ(grid->tree().isValueOn({x, y, z}), in_band) << x << " " << y << " " << z;
                active += in_band;
                if (in_band) {
                    ASSERT_NEAR(value, distance_m, 1e-5);
                } else {
                    ASSERT_FLOAT_EQ(std::abs(value), static_cast<float>(kTruncation_m));
                    // Either never seen, or far behind the surface.
                    ASSERT_TRUE(value > 0 || distance_m < 0);
                    inside += value < 0;
                }
            }
    EXPECT_GT(active, 5000);
    EXPECT_GT(inside, 1000);
    EXPECT_EQ(grid->activeVoxelCount(), static_cast<openvdb::Index64>(active));
}

TEST_F(VdbWriter, ColoursAreLinear) {
    ASSERT_TRUE(WriteVdb(path, map).ok());
    const auto surface = openvdb::gridPtrCast<openvdb::FloatGrid>(Read("surface"));
    const auto colour = openvdb::gridPtrCast<openvdb::Vec3SGrid>(Read("Cd"));
    ASSERT_TRUE(colour);
    EXPECT_EQ(colour->activeVoxelCount(), surface->activeVoxelCount());
    for (auto voxel = colour->cbeginValueOn(); voxel; ++voxel) {
        const openvdb::Vec3d p = colour->transform().indexToWorld(voxel.getCoord());
        const Eigen::Vector3d expected = Paint({p.x(), p.y(), p.z()});
        for (int c = 0; c < 3; ++c)
            ASSERT_NEAR(voxel.getValue()[c], Linear(expected(c)), 0.005) << voxel.getCoord();
    }
}

TEST_F(VdbWriter, WhatWasNeverSeenIsBackground) {
    const BlockId id = map.Find({0, 0, 4});
    const BlockId block = id != kUnknownBlock ? id : 1;
    const BlockCoord c = map.coord(block);
    for (int i = 0; i < kBlockVoxels; ++i)
        if (i != 1 + 8 * 2 + 64 * 3) map.field(block)[i] = kUnknownField;
    map.field(block)[1 + 8 * 2 + 64 * 3] = testing_support::PackField(-0.5);
    ASSERT_TRUE(WriteVdb(path, map).ok());
    const auto grid = openvdb::gridPtrCast<openvdb::FloatGrid>(Read("surface"));
    const openvdb::Coord origin(8 * c.x, 8 * c.y, 8 * c.z);
    EXPECT_NEAR(grid->tree().getValue(origin.offsetBy(1, 2, 3)), -0.5 * kTruncation_m, 1e-5);
    EXPECT_FLOAT_EQ(grid->tree().getValue(origin.offsetBy(3, 2, 1)),
                    static_cast<float>(kTruncation_m));
    EXPECT_FALSE(grid->tree().isValueOn(origin.offsetBy(3, 2, 1)));
    map.Release(block);
    ASSERT_TRUE(WriteVdb(path, map).ok());
    EXPECT_FALSE(openvdb::gridPtrCast<openvdb::FloatGrid>(Read("surface"))
                     ->tree()
                     .isValueOn(origin.offsetBy(1, 2, 3)));
}

// OpenVDB itself gives each file a random unique tag.
TEST_F(VdbWriter, TheSameMapGivesTheSameBytesAndAnotherAnotherIdentity) {
    ASSERT_TRUE(WriteVdb(path, map).ok());
    ASSERT_TRUE(WriteVdb(folder / "again.vdb", map).ok());
    map.field(1)[7] = testing_support::PackField(0.25);
    ASSERT_TRUE(WriteVdb(folder / "other.vdb", map).ok());
    const auto bytes = [](const std::string& file) {
        return ReadWholeFile(file, std::size_t{1} << 28).value();
    };
    EXPECT_TRUE(bytes(path) == bytes(folder / "again.vdb"));
    openvdb::initialize();
    std::string identities[2];
    for (const bool other : {false, true}) {
        openvdb::io::File file(other ? folder / "other.vdb" : path);
        file.open();
        identities[other] = file.getUniqueTag();
    }
    EXPECT_EQ(identities[0], bytes(path).substr(21, 36));
    EXPECT_NE(identities[0], identities[1]);
}

TEST_F(VdbWriter, VdbPrintListsBothGrids) {
    if (std::system("command -v vdb_print >/dev/null") != 0)
        GTEST_SKIP() << "needs vdb_print (libopenvdb-tools)";
    ASSERT_TRUE(WriteVdb(path, map).ok());
    for (const char* name : {"surface", "Cd"})
        EXPECT_EQ(std::system(("vdb_print " + path + " | grep -qw " + name).c_str()), 0) << name;
}

TEST_F(VdbWriter, AnEmptyMapAndAFullDisk) {
    EXPECT_TRUE(WriteVdb(path, BlockMap(map.config())).ok());
    EXPECT_EQ(openvdb::gridPtrCast<openvdb::FloatGrid>(Read("surface"))->activeVoxelCount(), 0u);
    EXPECT_NE(WriteVdb(folder / "none/a.vdb", map).message().find("none/a.vdb"), std::string::npos);
    if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "needs /dev/full (Linux)";
    EXPECT_NE(WriteVdb("/dev/full", map).message().find("no space"), std::string::npos);
}

}  // namespace
}  // namespace tessera
