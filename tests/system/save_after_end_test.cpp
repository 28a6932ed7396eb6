// What the user saves after a run has ended, while its window is still open.
#include <algorithm>
#include <filesystem>
#include <map>
#include <optional>

#include "io/mesh_io.h"
#include "run/scanned.h"
#include "scan/faulty_disk.h"
#include "system/engine_fixture.h"
#include "system/run_control.h"

namespace tessera {
namespace {

using testing_support::DiskFault;
using testing_support::FaultyDisk;

class SaveAfterEnd : public EngineTest, public testing::WithParamInterface<bool> {
  protected:
    void TearDown() override { engine.reset(); }  // the link must outlive it
    std::string Notices() {
        std::string all;
        while (const auto notice = engine->TakeNotice()) all += *notice + "\n";
        return all;
    }
    // Saves a scan that has all of the run.
    void ExpectSaved() {
        Notices();
        engine->Save({Command::kSaveScan, folder / "late.scan"});
        EXPECT_EQ(Notices(), "scan saved: " + (folder / "late.scan") + "\n");
        const auto stored = ReadScanFile(folder / "late.scan");
        ASSERT_TRUE(stored.ok()) << stored.message();
        EXPECT_EQ(stored.value().mesh.triangles.size(), triangles);
        EXPECT_EQ(std::ssize(stored.value().path),
                  std::ranges::count_if(Reports(), &FrameReport::tracked));
    }
    ViewerLink link;
    TempFolder folder;
    std::optional<FaultyDisk> disk;  // outlives the engine
    std::size_t triangles = 0;       // of the run's mesh
};

TEST_P(SaveAfterEnd, MeshAndScanAreThoseOfTheRun) {
    viewer = &link;
    config.live.queue_frames = 30;  // no frame is dropped, even on a slow machine
    Make(GetParam(), {.count = 12});
    TakeAll();
    engine->KeepMap();
    const TriangleMesh mesh = engine->TakeMesh();
    ASSERT_TRUE(engine->has_map());
    engine->Save({Command::kSaveMesh, folder / "late.ply"});
    engine->Save({Command::kSaveMesh, folder / "again.ply"});
    engine->Save({Command::kSaveScan, folder / "late.scan"});
    engine->Save({Command::kSaveScan, folder / "more.scan"});
    const std::string said = Notices();
    EXPECT_NE(said.find("scan saved: " + (folder / "late.scan")), std::string::npos) << said;
    EXPECT_NE(said.find("already saved"), std::string::npos) << said;
    EXPECT_FALSE(std::filesystem::exists(folder / "more.scan"));
    for (const char* name : {"late.ply", "again.ply"}) {
        const auto saved = ReadPly(folder / name);
        ASSERT_TRUE(saved.ok()) << saved.message();
        EXPECT_EQ(saved.value().triangles.size(), mesh.triangles.size()) << name;
    }
    const auto stored = ReadScanFile(folder / "late.scan");
    ASSERT_TRUE(stored.ok()) << stored.message();
    EXPECT_EQ(stored.value().mesh.triangles.size(), mesh.triangles.size());
    EXPECT_EQ(stored.value().path.size(), Reports().size());
}

// Then another path may be tried.
TEST_P(SaveAfterEnd, WhatCouldNotBeWrittenIsNotReportedAsSaved) {
    viewer = &link;
    config.live.queue_frames = 30;
    Make(GetParam(), {.count = 12});
    TakeAll();
    engine->KeepMap();
    triangles = engine->TakeMesh().triangles.size();
    disk.emplace();
    disk->Start(folder.path());
    std::size_t beginning = 0;  // operations until a scan is begun
    {
        const auto other = BeginScan(folder / "other.scan", Source().info(), config);
        ASSERT_TRUE(other.ok()) << other.message();
        beginning = disk->operations();
    }
    disk->Start(folder.path());
    disk->FailAt(beginning, DiskFault::kFull, true);
    engine->Save({Command::kSaveScan, folder / "full.scan"});
    const std::string said = Notices();
    EXPECT_NE(said.find("no longer saved"), std::string::npos) << said;
    EXPECT_EQ(said.find("scan saved"), std::string::npos) << said;
    EXPECT_FALSE(std::filesystem::exists(folder / "full.scan"));
    disk->Mend();
    ExpectSaved();
}

TEST_P(SaveAfterEnd, AScanThatCouldNotBeWrittenDuringTheRunCanBeSaved) {
    viewer = &link;
    config.live.queue_frames = 30;
    disk.emplace();
    disk->Start(folder.path());
    Result<ScanPlan> plan = BeginScan(folder / "full.scan", Source().info(), config);
    ASSERT_TRUE(plan.ok()) << plan.message();
    disk->FailAt(disk->operations(), DiskFault::kFull, true);
    EngineInput input = Input({.live = true});
    input.scan = std::move(plan.value());
    if (GetParam())
        engine = std::make_unique<LiveEngine>(std::move(input));
    else
        engine = std::make_unique<LockstepEngine>(std::move(input));
    const auto await = [&](const std::string& text) {
        while (Messages().find(text) == std::string::npos) ASSERT_TRUE(Next());
    };
    await("the scan is no longer saved: ");
    Ask(Command::kSaveScan, folder / "more.scan");
    await("this scan could not be written and is no longer saved: " + (folder / "full.scan"));
    Ask(Command::kStop);
    TakeAll();
    engine->KeepMap();
    triangles = engine->TakeMesh().triangles.size();
    disk->Mend();
    ExpectSaved();
}

// However little of the map was meshed during the run.
TEST_P(SaveAfterEnd, TheWindowGetsAllOfTheFinalMesh) {
    viewer = &link;
    config.live.mesh_blocks = 1;
    config.live.queue_frames = 30;
    config.meshing.min_component_triangles = 0;
    Make(GetParam(), {.count = 12});
    std::map<BlockId, std::size_t> shown;
    bool last = false, whole = false;
    const auto take = [&] {
        for (MeshUpdate update; link.meshes.TryPop(update);) {
            EXPECT_FALSE(last) << "there is more";
            last = update.last, whole = update.whole;
            if (update.clear) shown.clear();
            for (const GeometryBlock& block : update.blocks)
                shown[block.id] = block.geometry.indices.size() / 3;
        }
        std::size_t all = 0;
        for (const auto& [id, count] : shown) all += count;
        return all;
    };
    while (Next()) take();
    engine->KeepMap();
    const TriangleMesh mesh = engine->TakeMesh();
    ASSERT_LT(take(), mesh.triangles.size() / 2);
    EXPECT_FALSE(last);
    for (std::size_t i = 0; i < link.meshes.capacity(); ++i) link.meshes.TryPush({});
    EXPECT_FALSE(engine->SendFinalMesh());  // there is no room
    take();
    for (bool sent = false; !sent; take()) sent = engine->SendFinalMesh();
    EXPECT_TRUE(last && whole);
    EXPECT_EQ(take(), mesh.triangles.size());
    EXPECT_TRUE(engine->SendFinalMesh());
    EXPECT_TRUE(link.meshes.empty());
}

TEST_P(SaveAfterEnd, OfARunThatOnlyLocalisedAMeshButNoScan) {
    const SourceInfo info = Source().info();
    const auto run = [&](Result<ScanPlan> plan) {
        ASSERT_TRUE(plan.ok()) << plan.message();
        EngineInput input = Input({.count = 12});
        input.scan = std::move(plan.value());
        if (GetParam())
            engine = std::make_unique<LiveEngine>(std::move(input));
        else
            engine = std::make_unique<LockstepEngine>(std::move(input));
        TakeAll();
        engine->KeepMap();
        engine->TakeMesh();
    };
    run(BeginScan(folder / "a.scan", info, config));
    run(OpenToLocalise(folder / "a.scan", info, config));
    ASSERT_TRUE(engine->has_map());
    Notices();
    engine->Save({Command::kSaveScan, folder / "late.scan"});
    EXPECT_EQ(Notices(), std::string(kMapIsKept) + "\n");
    EXPECT_FALSE(std::filesystem::exists(folder / "late.scan"));
    engine->Save({Command::kSaveMesh, folder / "late.ply"});
    EXPECT_TRUE(std::filesystem::exists(folder / "late.ply"));
}

TEST_P(SaveAfterEnd, WithoutAWindowTheMapIsReleased) {
    Make(GetParam(), {.count = 3});
    TakeAll();
    EXPECT_TRUE(engine->has_map());
    engine->TakeMesh();
    EXPECT_FALSE(engine->has_map());
}

INSTANTIATE_TEST_SUITE_P(LockstepAndLive, SaveAfterEnd, testing::Bool());

}  // namespace
}  // namespace tessera
