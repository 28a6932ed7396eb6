// Limits that are too small, and scans that give blocks back damaged or take none any more.
#include <gtest/gtest.h>

#include <string>

#include "system/paging_fixture.h"
#include "system/paging_stage.h"

namespace tessera {
namespace paging_test {
namespace {

TEST_F(Paging, ALimitThatIsTooSmallIsSaidOnce) {
    Run(false, 1);
    const std::string said = Messages();
    const std::size_t at = said.find("mapping.memory_limit_mb: 1 MB is not enough");
    ASSERT_NE(at, std::string::npos) << said;
    EXPECT_EQ(said.find("memory_limit_mb", at + 20), std::string::npos);
}

// The blocks between 2 and 4 m of the hall are damaged while they are paged out.
TEST_F(Paging, WhatCannotBeReadBackIsSaidOnceAndNothingIsFusedThere) {
    Start(false, 24);
    TakeFrames(kSteps + kTurn);
    {
        auto reader = CubeReader::Open(path);
        ASSERT_TRUE(reader.ok());
        auto database = Database::Open(path, Database::Access::kWrite);
        ASSERT_TRUE(database.ok());
        const double cube_m = kCubeBlocks * kBlockSide * config.pipeline.map.voxel_size_m;
        const auto cubes = reader.value()->Cubes();
        ASSERT_TRUE(cubes.ok());
        for (const auto& [key, blocks] : cubes.value()) {
            const double z_m = CubeOfKey(key).z * cube_m;
            if (z_m < 2 || z_m > 4) continue;
            const std::string keys =
                std::to_string(key) + " AND " + std::to_string(key + kCubeKeys - 1);
            ASSERT_TRUE(
                database.value()
                    ->Execute("UPDATE blocks SET checksum = checksum + 1 WHERE key BETWEEN " + keys)
                    .ok());
        }
    }
    TakeAll();
    EXPECT_TRUE(engine->status().ok()) << engine->status().message();
    const std::string said = Messages();
    const std::size_t at = said.find("tessera scan repair");
    ASSERT_NE(at, std::string::npos) << said;
    EXPECT_NE(said.find("not fused"), std::string::npos);
    EXPECT_EQ(said.find("tessera scan repair", at + 1), std::string::npos);
    int not_fused = 0;
    for (const FrameOutcome& o : outcomes) {
        if (o.kind != Kind::kFrame) continue;
        const double z_m = WalkPose(static_cast<int>(o.report.index)).translation().z();
        const bool back = o.report.index >= kSteps + kTurn;
        not_fused += !o.report.fused;
        EXPECT_EQ(o.report.fused, !o.fusion_dropped);
        const bool far = !back || z_m > 8, within = back && z_m > 3 && z_m < 5;
        EXPECT_TRUE(o.report.fused || !far) << o.report.index;
        EXPECT_FALSE(o.report.fused && within) << o.report.index;
    }
    EXPECT_GT(not_fused, 5);
    EXPECT_TRUE(engine->TakeMesh().triangles.empty());
    EXPECT_NE(engine->status().message().find("tessera scan repair"), std::string::npos)
        << engine->status().message();
}

// A locked database acts like a full disk. Saving stops while part of the map is paged out.
TEST_F(Paging, AFileThatTakesNothingAnyMoreCostsMemoryButNoMap) {
    constexpr int kAfter = 12;  // frames
    const auto end = [&] {
        TakeFrames(kAfter);
        stop = true;
        TakeAll();
        stop = false;
        EXPECT_TRUE(engine->status().ok()) << engine->status().message();
    };
    Start(false, 0);
    TakeFrames(kSteps);
    end();
    const TriangleMesh whole = engine->TakeMesh();

    Start(false, 24);
    TakeFrames(kSteps);
    auto database = Database::Open(path, Database::Access::kWrite);
    ASSERT_TRUE(database.value()->Execute("BEGIN IMMEDIATE").ok());
    end();
    EXPECT_NE(Messages().find("no longer saved"), std::string::npos);
    const TriangleMesh mesh = engine->TakeMesh();
    EXPECT_TRUE(engine->status().ok()) << engine->status().message();
    EXPECT_EQ(mesh.vertices.size(), whole.vertices.size());
    EXPECT_EQ(mesh.triangles.size(), whole.triangles.size());
}

}  // namespace
}  // namespace paging_test
}  // namespace tessera
