#include "run/run_source.h"

#include <gtest/gtest.h>

#include "io/file.h"
#include "report/run_record.h"
#include "support/temp_folder.h"

namespace tessera {
namespace {

RunRecord Record(const std::string& json) {
    const TempFolder folder;
    EXPECT_TRUE(WriteTextFile(folder / "run.json", json).ok());
    const Result<RunRecord> record = ReadRunRecord(folder / "run.json");
    EXPECT_TRUE(record.ok()) << record.message();
    return record.ok() ? record.value() : RunRecord{};
}

TEST(SourceSettings, AreWhatTheRunHasUsed) {
    const RunConfig config = SourceSettings(Record(
        R"({"source": {"camera": {"width": 64, "height": 48, "fx": 60, "fy": 61, "cx": 31, "cy": 23}},
            "vignetting": {"used": true, "share": 0.2},
            "colour_shift": {"used": true, "x_px": 5.5, "y_px": -4},
            "colour_delay": {"used": true, "delay_ms": 9, "corrected_ms": 8},
            "depth_distortion": {"used": true, "columns": 2, "rows": 2, "per_m": [0, 0.5, 0, 1]},
            "configuration": {"synthetic.speed": 2.5, "source.colour_delay_s": 0.01, "source.unheard_of": 1, "mapping.voxel_size_m": 0.5}})"));
    EXPECT_EQ(config.source.camera, (PinholeCamera{64, 48, 60, 61, 31, 23}));
    EXPECT_EQ(config.openni.fx, 60);  // a .oni recording is opened with these
    EXPECT_EQ(config.openni.fy, 61);
    EXPECT_EQ(config.openni.cx, 31);
    EXPECT_EQ(config.openni.cy, 23);
    EXPECT_EQ(config.source.vignetting, 0.2);
    EXPECT_EQ(config.source.colour_shift_px, Eigen::Vector2d(5.5, -4));
    EXPECT_NEAR(config.source.colour_delay_s, 0.018, 1e-12);
    EXPECT_EQ(config.source.depth_distortion, (DepthDistortion{2, 2, {0, 0.5f, 0, 1}}));
    EXPECT_EQ(config.synthetic.speed, 2.5);
    EXPECT_EQ(config.pipeline.map.voxel_size_m, RunConfig().pipeline.map.voxel_size_m);
}

TEST(SourceSettings, LeaveOutWhatWasNotUsed) {
    for (
        const char* json :
        {"{}", R"({"source": {"camera": {"width": 64}}})",
         R"({"vignetting": {"used": false, "share": 0.2}, "colour_shift": {"x_px": 5}})",
         R"({"colour_delay": {"used": false, "corrected_ms": 8}})",
         R"({"vignetting": 3, "colour_shift": [], "colour_delay": 1})",
         R"({"depth_distortion": {"used": false, "columns": 2, "rows": 2, "per_m": [0, 0, 0, 1]}})",
         R"({"depth_distortion": {"used": true, "columns": 9, "rows": 2, "per_m": [0, 0, 0, 1]}})"}) {
        const RunConfig config = SourceSettings(Record(json));
        EXPECT_FALSE(config.source.camera) << json;
        EXPECT_EQ(config.openni.fx, 0) << json;
        EXPECT_EQ(config.source.vignetting, 0) << json;
        EXPECT_TRUE(config.source.colour_shift_px.isZero()) << json;
        EXPECT_EQ(config.source.colour_delay_s, 0) << json;
        EXPECT_TRUE(config.source.depth_distortion.empty()) << json;
    }
}

TEST(OpenSourceOf, ACamerasFramesAreGone) {
    RunRecord run;
    EXPECT_NE(OpenSourceOf(run).message().find("does not name"), std::string::npos);
    run.source_name = "openni2:";
    EXPECT_NE(OpenSourceOf(run).message().find("are gone"), std::string::npos);
    EXPECT_TRUE(OpenSourceOf(run, "synthetic:desk").ok());
    run.source_name = "synthetic:desk";
    EXPECT_TRUE(OpenSourceOf(run).ok());
}

}  // namespace
}  // namespace tessera
