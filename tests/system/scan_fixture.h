// Runs in the box room that are saved and resumed.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <memory>
#include <string>
#include <utility>

#include "run/scan_export.h"
#include "support/box_room_source.h"
#include "support/temp_folder.h"
#include "system/engine_fixture.h"
#include "system/scan_stage.h"

namespace tessera {

class Scan : public EngineTest {
  protected:
    // Runs the engine to the end and returns the mesh that it would write.
    TriangleMesh Run(bool live, ScanPlan plan, const Source::Options& options,
                     std::int64_t start = 0) {
        EngineInput input = Input(options);
        input.scan = std::move(plan);
        input.selection.start = start;
        outcomes.clear();
        if (live)
            engine = std::make_unique<LiveEngine>(std::move(input));
        else
            engine = std::make_unique<LockstepEngine>(std::move(input));
        TakeAll();
        EXPECT_TRUE(engine->status().ok()) << engine->status().message();
        return engine->TakeMesh();
    }
    ScanPlan New() {
        Result<ScanPlan> plan = BeginScan(path, testing_support::BoxRoomSource().info(), config);
        EXPECT_TRUE(plan.ok()) << plan.message();
        return std::move(plan.value());
    }
    ScanPlan Again() {
        Result<ScanPlan> plan =
            ResumeScan(path, testing_support::BoxRoomSource().info(), config, false);
        EXPECT_TRUE(plan.ok()) << plan.message();
        return std::move(plan.value());
    }
    ScanContent Content() {
        Result<ScanContent> scan = ReadScan(path, {.map = true, .frames = true});
        EXPECT_TRUE(scan.ok()) << scan.message();
        return std::move(scan.value());
    }
    static void ExpectSame(const TriangleMesh& a, const TriangleMesh& b) {
        EXPECT_EQ(a.vertices, b.vertices);
        EXPECT_EQ(a.colours, b.colours);
        EXPECT_EQ(a.triangles, b.triangles);
    }

    TempFolder folder;
    std::string path = folder / "a.scan";
};

}  // namespace tessera
