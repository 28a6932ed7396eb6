// Maps that exceed their memory limit, in a long box room.
#include "system/paging_stage.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "run/scan_export.h"
#include "system/paging_fixture.h"

namespace tessera {
namespace paging_test {
namespace {

TEST_F(Paging, ALimitChangesNothingButTheMemory) {
    const TriangleMesh whole = Run(false, 0);
    const std::int64_t blocks = resident;
    const auto expected = std::move(outcomes);
    constexpr double kLimit_mb = 24;
    const TriangleMesh mesh = Run(false, kLimit_mb);
    ASSERT_GT(whole.triangles.size(), 100000u);
    EXPECT_EQ(mesh.vertices, whole.vertices);
    EXPECT_EQ(mesh.normals, whole.normals);
    EXPECT_EQ(mesh.colours, whole.colours);
    EXPECT_EQ(mesh.triangles, whole.triangles);
    EXPECT_LT(2 * MostBlocks(), blocks);
    for (const FrameOutcome& o : outcomes)
        EXPECT_LT(static_cast<double>(o.map.bytes), 1e6 * kLimit_mb);
    EXPECT_EQ(Messages().find("memory_limit"), std::string::npos);
    EXPECT_FALSE(std::filesystem::exists(path + "-wal")) << "the journal is merged into the file";

    {
        const Result<ScanContent> scan = ReadScan(path, {});
        ASSERT_TRUE(scan.ok()) << scan.message();
        EXPECT_EQ(scan.value().map->count(), blocks) << "the file holds the whole map";
    }
    // The paging of blocks depends only on the frames.
    ASSERT_EQ(std::remove(path.c_str()), 0);
    const auto first = std::move(outcomes);
    Run(false, kLimit_mb);
    ASSERT_EQ(outcomes.size(), first.size());
    for (std::size_t i = 0; i < first.size(); ++i)
        EXPECT_EQ(outcomes[i].map.blocks, first[i].map.blocks) << i;
}

TEST_F(Paging, LabelsAndObjectsAreTheSameWithALimit) {
    labels = true;
    aside_rad = 0.6;
    config.labels.min_observations = 4;
    const TriangleMesh whole = Run(false, 0);
    const std::string objects = ObjectsJson(engine->objects());
    ASSERT_EQ(engine->objects().size(), 2u) << objects;
    ASSERT_GT(Labelled(whole), 1000);
    const std::int64_t blocks = resident;
    const TriangleMesh mesh = Run(false, 28);
    EXPECT_LT(2 * MostBlocks(), blocks);
    EXPECT_EQ(mesh.vertices, whole.vertices);
    EXPECT_EQ(mesh.triangles, whole.triangles);
    EXPECT_TRUE(mesh.labels == whole.labels);
    EXPECT_EQ(ObjectsJson(engine->objects()), objects);
    Result<ScanContent> scan = ReadScan(path, {});
    ASSERT_TRUE(scan.ok()) << scan.message();
    const Result<TriangleMesh> exported = MeshOfScan(scan.value());
    ASSERT_TRUE(exported.ok()) << exported.message();
    EXPECT_TRUE(exported.value().labels == whole.labels);
}

// The first poster must not shrink in the window after it has been paged out.
TEST_F(Paging, ObjectsInTheWindowDoNotShrinkWhileTheyAreAway) {
    labels = true;
    aside_rad = 0.6;
    config.labels.min_observations = 4;
    config.live.mesh_blocks = 100000;
    ViewerLink link;
    viewer = &link;
    std::vector<MapObject> before, last;
    Start(false, 28);
    for (int i = 0; i < kSteps; ++i) {
        TakeFrames(1);
        MeshUpdate mesh;
        while (link.meshes.TryPop(mesh)) {
        }
        while (link.objects.TryPop(last)) {
            if (last.size() == 1) before = last;
        }
    }
    ASSERT_EQ(before.size(), 1u);
    ASSERT_EQ(last.size(), 2u);
    const auto poster = std::ranges::find(last, before[0].id, &MapObject::id);
    ASSERT_NE(poster, last.end());
    EXPECT_GT(poster->vertices, 500);
    EXPECT_GE(poster->vertices, 0.95 * static_cast<double>(before[0].vertices));
    EXPECT_LT((poster->box.min() - before[0].box.min()).norm(), 0.03);
    EXPECT_LT((poster->box.max() - before[0].box.max()).norm(), 0.03);
}

// Some frames are not fused because their blocks are paged out. No block may be duplicated or lost.
TEST_F(Paging, LiveKeepsTheLimitAndTheMap) {
    const TriangleMesh mesh = Run(true, 24);
    const Result<ScanContent> scan = ReadScan(path, {});
    ASSERT_TRUE(scan.ok()) << scan.message();
    const std::int64_t stored = scan.value().map->count();
    EXPECT_GE(stored, resident);
    ASSERT_GT(mesh.triangles.size(), 100000u);
    const BoxRoom hall = Hall();
    for (const Eigen::Vector3f& v : mesh.vertices)
        ASSERT_LT(std::abs(hall.SignedDistance(v.cast<double>())), 0.02) << v.transpose();
    if (2 * stored <= 3 * resident)
        GTEST_SKIP() << "the machine is too slow: blocks were not saved in time to be paged out";
}

TEST_F(Paging, AnEmptyMapBeginsWhileCubesAreUnderWay) {
    ViewerLink link;
    viewer = &link;
    Start(false, 24);
    TakeFrames(kSteps + kTurn + 5);
    Ask(Command::kReset);
    TakeAll();
    EXPECT_TRUE(engine->status().ok()) << engine->status().message();
    EXPECT_EQ(Count(Kind::kReset), 1);
    EXPECT_EQ(Messages().find("scan repair"), std::string::npos) << Messages();
    const TriangleMesh mesh = engine->TakeMesh();
    ASSERT_GT(mesh.triangles.size(), 50000u);
    const BoxRoom hall = Hall();
    for (const Eigen::Vector3f& v : mesh.vertices)
        ASSERT_LT(std::abs(hall.SignedDistance(v.cast<double>())), 0.02) << v.transpose();
}

TEST_F(Paging, LiveCanBeLeftAtAnyTime) {
    for (const int frames : {1, kSteps, kSteps + kTurn + 10}) {
        Start(true, 24);
        for (int i = 0; i < frames && Next(); ++i) {
        }
        engine.reset();
        std::remove(path.c_str());
    }
}

}  // namespace
}  // namespace paging_test
}  // namespace tessera
