// Whole models of a rendered desk, seen from places between the camera's.
#include "run/finish_run.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>
#include <span>

#include "io/image_io.h"
#include "io/mesh_io.h"
#include "io/trajectory.h"
#include "render/mesh_picture.h"
#include "report/run_record.h"
#include "run/open_source.h"
#include "run/run.h"
#include "support/temp_folder.h"
#include "synth/sequence_writer.h"
#include "synth/synthetic_source.h"

namespace tessera {
namespace {

constexpr Rgb8 kNothing{255, 0, 255};

RenderStyle Plain() {
    RenderStyle style;
    style.background_top = style.background_bottom = kNothing;
    return style;
}

// Squared error per channel over the pixels where both pictures show something.
struct Errors {
    double vertex = 0, texture = 0;
    std::int64_t pixels = 0;

    void Add(const ColourImage& truth, const ColourImage& by_vertex,
             const ColourImage& by_texture) {
        const auto square = [](const Rgb8& a, const Rgb8& b) {
            const int r = a.r - b.r, g = a.g - b.g, bl = a.b - b.b;
            return (r * r + g * g + bl * bl) / 3.0;
        };
        for (std::size_t i = 0; i < truth.size(); ++i) {
            if (by_vertex.data()[i] == kNothing || by_texture.data()[i] == kNothing) continue;
            vertex += square(truth.data()[i], by_vertex.data()[i]);
            texture += square(truth.data()[i], by_texture.data()[i]);
            ++pixels;
        }
    }
    static double Psnr(double sum, std::int64_t count) {
        return 10 * std::log10(255.0 * 255.0 * static_cast<double>(count) / sum);
    }
};

class FinishedDesk : public testing::Test {
  protected:
    void SetUp() override {
        config.synthetic.frames = 60;
        config.synthetic.camera = {320, 240, 262.5, 262.5, 159.5, 119.5};
    }
    // Frames with odd numbers, which the run leaves out.
    std::vector<Frame> LeftOut() {
        std::vector<Frame> left_out;
        auto source = OpenSynthetic("synthetic:desk", config.synthetic);
        EXPECT_TRUE(source.ok()) << source.message();
        if (!source.ok()) return left_out;
        Frame frame;
        for (const std::int64_t index : {15, 31, 45}) {
            source.value()->Seek(index);
            if (source.value()->Read(frame).status == ReadStatus::kOk) left_out.push_back(frame);
        }
        return left_out;
    }
    RunSummary Run(const std::string& scan, const std::string& source = "synthetic:desk") {
        RunRequest request;
        request.source = source;
        request.output_folder = folder / "run";
        request.selection.stride = 2;
        request.scan_file = scan;
        const std::atomic<bool> stop{false};
        const auto run = ExecuteRun(request, config, {}, stop);
        EXPECT_TRUE(run.ok()) << run.message();
        return run.ok() ? run.value() : RunSummary{};
    }
    Result<FinishedModel> Finish(const std::string& input) {
        return FinishRun({.input = input}, [](const char*, double) { return true; });
    }

    // The desk as a sensor records it whose depth z is to be corrected to z / (1 + offset z).
    void WriteFarRecording(const std::string& to, double offset_per_m) {
        const auto source = OpenSynthetic("synthetic:desk", config.synthetic);
        ASSERT_TRUE(source.ok()) << source.message();
        ASSERT_TRUE(WriteSequence(*source.value(), to, {}).ok());
        for (const auto& file : std::filesystem::directory_iterator(to + "/depth")) {
            auto depth = ReadDepthImage(file.path().string());
            ASSERT_TRUE(depth.ok()) << depth.message();
            for (std::uint16_t& stored : std::span(depth.value().data(), depth.value().size())) {
                const double z_m = stored / 5000.0, raw_m = z_m / (1 - offset_per_m * z_m);
                stored = static_cast<std::uint16_t>(std::min(5000 * raw_m + 0.5, 65535.0));
            }
            ASSERT_TRUE(WriteDepthImage(file.path().string(), depth.value()).ok());
        }
    }

    TempFolder folder;
    RunConfig config;
};

TEST_F(FinishedDesk, IsSharperThanVertexColoursAtOtherPlaces) {
    config.synthetic.camera = PinholeCamera();  // whose pixels are smaller than the voxels
    Run("");
    const Result<FinishedModel> finished = Finish(folder / "run");
    ASSERT_TRUE(finished.ok()) << finished.message();
    const auto mesh = ReadPly(folder / "run/mesh.ply");
    const auto path = ReadTrajectory(folder / "run/trajectory.txt");
    ASSERT_TRUE(mesh.ok() && path.ok());
    Errors errors;
    const PinholeCamera& camera = config.synthetic.camera;
    const std::vector<Frame> left_out = LeftOut();
    ASSERT_EQ(left_out.size(), 3u);
    for (const Frame& frame : left_out) {
        const auto T_world_camera = InterpolatePose(path.value().poses, frame.stamp_s);
        ASSERT_TRUE(T_world_camera);
        errors.Add(frame.colour, RenderMesh(mesh.value(), camera, *T_world_camera, Plain()),
                   RenderTextured(finished.value().model, camera, *T_world_camera, Plain()));
    }
    const double vertex_db = Errors::Psnr(errors.vertex, errors.pixels),
                 texture_db = Errors::Psnr(errors.texture, errors.pixels);
    std::cout << "PSNR " << vertex_db << " dB by vertex colours, " << texture_db
              << " dB by texture\n";
    EXPECT_GT(texture_db, vertex_db + 4);
    const FinishReport& report = finished.value().report;
    EXPECT_GT(report.model().seen_share, 0.85);
    EXPECT_LE(report.frames, 30);  // three of each stretch
    EXPECT_GE(report.frames, report.views);
}

TEST_F(FinishedDesk, AScanIsFinishedByItsOwnFrames) {
    config.scan.frames = ScanConfig::Frames::kAll;
    config.synthetic.frames = 40;
    config.pipeline.shutter.depth_readout_s = 0.001;
    config.pipeline.shutter.colour_readout_s = 0.002;
    config.pipeline.trackers.photometric.shutter.enabled = false;
    Run(folder / "desk.scan");
    const Result<FinishedModel> finished = Finish(folder / "desk.scan");
    ASSERT_TRUE(finished.ok()) << finished.message();
    EXPECT_LE(finished.value().report.frames, 20);
    EXPECT_GT(finished.value().report.views, 0);
    EXPECT_GT(finished.value().report.model().seen_share, 0.8);
    // What it needs of the scan besides the frames.
    const auto scan = OpenSource(folder / "desk.scan", config);
    ASSERT_TRUE(scan.ok()) << scan.message();
    FrameSource& source = *scan.value();
    EXPECT_EQ(source.info().depth_readout_s, 0.001);
    EXPECT_EQ(source.info().colour_readout_s, 0.002);
    std::vector<double> stamps_s;
    for (Frame frame; source.Read(frame).status == ReadStatus::kOk;)
        stamps_s.push_back(frame.stamp_s);
    EXPECT_EQ(source.Stamps_s(), stamps_s);
    const auto run = ReadRunRecord(folder / "run/run.json");
    ASSERT_TRUE(run.ok());
    EXPECT_EQ(run.value().depth_readout_s, 0.001);
    EXPECT_EQ(run.value().colour_readout_s, 0.002);
}

// Uncorrected, the frames would look through the whole surface, by 5 cm at a metre.
TEST_F(FinishedDesk, DepthIsCorrectedAsTheRunCorrectedIt) {
    constexpr double kOffset_per_m = 0.05;
    config.synthetic.frames = 40;
    config.scan.frames = ScanConfig::Frames::kAll;
    config.check_camera = false;
    config.pipeline.frame.disparity_offset_per_m = kOffset_per_m;
    ASSERT_NO_FATAL_FAILURE(WriteFarRecording(folder / "far", kOffset_per_m));
    Run(folder / "desk.scan", folder / "far");
    const auto of_scan = Finish(folder / "desk.scan"), of_run = Finish(folder / "run");
    ASSERT_TRUE(of_scan.ok() && of_run.ok()) << of_scan.message() << of_run.message();
    for (const FinishReport& report : {of_scan.value().report, of_run.value().report}) {
        EXPECT_GT(report.model().seen_share, 0.8);
        EXPECT_LT(report.flaps.triangles, report.triangles_before / 4);
    }
    // As if calibration.refine had found what was set, and the camera's focal lengths.
    std::ifstream old_file(folder / "run/run.json");
    nlohmann::json json = nlohmann::json::parse(old_file);
    ASSERT_EQ(json["configuration"]["frame.disparity_offset_per_m"], kOffset_per_m);
    json["configuration"]["frame.disparity_offset_per_m"] = 0;
    json["calibration"] = {
        {"used", true}, {"fx", 262.5}, {"fy", 262.5}, {"disparity_offset_per_m", kOffset_per_m}};
    json["source"]["camera"]["fx"] = json["source"]["camera"]["fy"] = 230;
    std::ofstream(folder / "run/run.json") << json;
    const auto refined = Finish(folder / "run");
    ASSERT_TRUE(refined.ok()) << refined.message();
    EXPECT_EQ(refined.value().report.flaps.triangles, of_run.value().report.flaps.triangles);
    EXPECT_NEAR(refined.value().report.model().seen_share, of_run.value().report.model().seen_share,
                1e-9);
}

TEST_F(FinishedDesk, WhatIsMissingIsNamed) {
    const auto said = [&](const std::string& input, const std::string& source) {
        const auto result =
            FinishRun({.input = input, .source = source}, [](const char*, double) { return true; });
        EXPECT_FALSE(result.ok());
        return result.message();
    };
    EXPECT_NE(said(folder / "none.scan", "").find("none.scan"), std::string::npos);
    EXPECT_NE(said(folder / "none.scan", "synthetic:desk").find("--source"), std::string::npos);
    EXPECT_NE(said(folder / ".", "").find("mesh.ply"), std::string::npos);
    config.synthetic.frames = 6;
    Run("");
    EXPECT_NE(said(folder / "run", "synthetic:nothing").find("nothing"), std::string::npos);
    EXPECT_NE(said(folder / "run", folder / "away").find("away"), std::string::npos);
    // Another recording, whose frames have other times.
    config.synthetic.fps = 7;
    auto other = OpenSynthetic("synthetic:corner", config.synthetic);
    ASSERT_TRUE(other.ok());
    Frame first;
    other.value()->Read(first);
    ASSERT_TRUE(WriteSequence(*other.value(), folder / "other", {}).ok());
    std::filesystem::remove(folder / "run/trajectory.txt");
    ASSERT_TRUE(
        WriteTrajectory(folder / "run/trajectory.txt", {{1000.5, Eigen::Isometry3d::Identity()}})
            .ok());
    EXPECT_NE(said(folder / "run", folder / "other").find("is it the run's source?"),
              std::string::npos);
}

}  // namespace
}  // namespace tessera
