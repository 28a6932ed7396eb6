#include "run/source_camera.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <vector>

#include "optimize/box_view.h"
#include "optimize/distorted_room.h"
#include "optimize/painted_room.h"
#include "optimize/squares_view.h"
#include "run/recorded_views.h"
#include "support/temp_folder.h"

namespace tessera {
namespace {

constexpr int kViews = 16;

// Colour lies `x`, `y` pixels beside its depth.
void WriteBoxViews(const TempFolder& folder, int x, int y) {
    std::vector<Frame> frames;
    for (int i = 0; i < kViews; ++i) frames.push_back(BoxView(i, x, y));
    CameraCalibration camera;
    camera.depth_scale = 1000;
    WriteViews(folder, frames, camera);
}

// Four seconds. Colour was taken `delay_s` later than its stamps say.
void WriteSquareViews(const TempFolder& folder, double delay_s) {
    std::vector<Frame> frames;
    for (int i = 0; i < 40; ++i) frames.push_back(squares_view::View(0.1 * i, delay_s));
    CameraCalibration camera;
    camera.pinhole = squares_view::kCamera;
    camera.depth_scale = 1000;
    WriteViews(folder, frames, camera);
}

// Pixels whose colour is that of the box and whose depth is not, or the other way round.
int PixelsBesideTheirSurface(FrameSource& source) {
    Frame frame;
    EXPECT_EQ(source.Read(frame).status, ReadStatus::kOk);
    int wrong = 0;
    for (std::size_t i = 0; i < frame.depth_m.size(); ++i)
        wrong += (frame.depth_m.data()[i] == 1.5f) != (frame.colour.data()[i].r > 145);
    return wrong;
}

TEST(OpenCheckedSource, PutsColourBackOntoItsSurface) {
    const TempFolder folder;
    WriteBoxViews(folder, 14, -9);
    RunRequest request;
    request.source = folder.path();
    RunConfig config;
    Result<CheckedSource> checked = OpenCheckedSource(request, config);
    ASSERT_TRUE(checked.ok()) << checked.message();
    ASSERT_TRUE(checked.value().found.colour_shift);
    EXPECT_TRUE(checked.value().found.colour_shift->used);
    EXPECT_NEAR(checked.value().found.colour_shift->x_px, 14, 0.5);
    ASSERT_EQ(checked.value().messages.size(), 1u);
    EXPECT_NE(checked.value().messages[0].find("px right of and"), std::string::npos);
    const int perimeter_px = 4 * 150;
    EXPECT_LT(PixelsBesideTheirSurface(*checked.value().source), perimeter_px);

    config.check_camera = false;
    checked = OpenCheckedSource(request, config);
    ASSERT_TRUE(checked.ok()) << checked.message();
    EXPECT_FALSE(checked.value().found.colour_shift);
    EXPECT_GT(PixelsBesideTheirSurface(*checked.value().source), 5 * perimeter_px);
}

TEST(OpenCheckedSource, LeavesARightRegistrationAlone) {
    const TempFolder folder;
    WriteBoxViews(folder, 0, 0);
    RunRequest request;
    request.source = folder.path();
    const Result<CheckedSource> checked = OpenCheckedSource(request, RunConfig());
    ASSERT_TRUE(checked.ok()) << checked.message();
    ASSERT_TRUE(checked.value().found.colour_shift);
    EXPECT_FALSE(checked.value().found.colour_shift->used);
    EXPECT_TRUE(checked.value().source->info().one_camera);
    EXPECT_EQ(PixelsBesideTheirSurface(*checked.value().source), 0);
}

TEST(OpenCheckedSource, CorrectsTheTimeStamps) {
    const TempFolder folder;
    WriteSquareViews(folder, 0.015);
    RunRequest request;
    request.source = folder.path();
    RunConfig config;
    config.source.colour_delay_s = 0.005;  // part of it is known
    const Result<CheckedSource> checked = OpenCheckedSource(request, config);
    ASSERT_TRUE(checked.ok()) << checked.message();
    ASSERT_TRUE(checked.value().found.colour_delay);
    EXPECT_TRUE(checked.value().found.colour_delay->used);
    EXPECT_NEAR(checked.value().found.colour_delay->delay_s, 0.01, 0.001);
    ASSERT_FALSE(checked.value().messages.empty());
    EXPECT_NE(checked.value().messages[0].find("later than its time stamps say: corrected by"),
              std::string::npos);
    FrameSource& source = *checked.value().source;
    Frame frame;
    ASSERT_TRUE(source.Seek(20));
    ASSERT_EQ(source.Read(frame).status, ReadStatus::kOk);
    const double corrected_s = frame.correction.colour_s - frame.correction.depth_s;
    EXPECT_NEAR(corrected_s, 0.015, 0.001);
    EXPECT_DOUBLE_EQ(corrected_s, 0.005 + checked.value().found.colour_delay->certain_s());
    EXPECT_NEAR(frame.stamp_s, 2 - corrected_s / 2, 1e-9);
    EXPECT_NEAR(frame.colour_stamp_s, 2 + corrected_s / 2, 1e-9);
}

// Colour of this camera is said to be read in 30 ms, and no row of it lies beside depth's.
TEST(OpenCheckedSource, TellsWhetherDepthIsReadRowByRow) {
    const TempFolder folder;
    WriteSquareViews(folder, 0);
    RunRequest request;
    request.source = folder.path();
    for (const double readout_s : {0.0, 0.03}) {
        RunConfig config;
        config.pipeline.shutter.colour_readout_s = readout_s;
        const std::atomic<bool> stop{false};
        const Result<RunSummary> run = ExecuteRun(request, config, {}, stop);
        ASSERT_TRUE(run.ok()) << run.message();
        ASSERT_TRUE(run.value().found.colour_delay);
        EXPECT_FALSE(run.value().found.colour_delay->used);
        const bool rolls = std::ranges::any_of(run.value().source.notes, [](const std::string& n) {
            return n.find("depth is read row by row") != std::string::npos;
        });
        EXPECT_EQ(rolls, readout_s > 0);
    }
}

TEST(OpenCheckedSource, EvensOutDarkCorners) {
    const TempFolder folder;
    std::vector<Frame> frames;
    for (int i = 0; i < 36; ++i) frames.push_back(painted_room::View(i, 0, 0.25));
    CameraCalibration camera;
    camera.pinhole = painted_room::kCamera;
    camera.depth_scale = 1000;
    camera.vignetting = 0.05;  // part of it is known
    WriteViews(folder, frames, camera);
    RunRequest request;
    request.source = folder.path();
    const Result<CheckedSource> checked = OpenCheckedSource(request, RunConfig());
    ASSERT_TRUE(checked.ok()) << checked.message();
    ASSERT_TRUE(checked.value().found.vignetting);
    EXPECT_TRUE(checked.value().found.vignetting->used);
    EXPECT_NEAR(checked.value().found.vignetting->share, 0.2, 0.02);
    ASSERT_EQ(checked.value().messages.size(), 1u);
    EXPECT_NE(checked.value().messages[0].find("% darker than its middle"), std::string::npos);
    Frame frame;
    ASSERT_EQ(checked.value().source->Read(frame).status, ReadStatus::kOk);
    const Frame even = painted_room::View(0, 0);
    for (const auto& [u, v] : {std::pair(0, 0), {319, 239}, {160, 120}, {5, 235}})
        EXPECT_NEAR(frame.colour(u, v).r, even.colour(u, v).r, 4) << u << ' ' << v;
}

TEST(OpenCheckedSource, SaysWhichCameraItAssumesForALog) {
    const TempFolder folder;
    RunRequest request;
    request.source = folder / "a.klg";
    std::ofstream log(request.source, std::ios::binary);
    const std::int32_t count = 1, bytes[] = {640 * 480 * 2, 0};  // depth, and no colour
    const std::int64_t stamp_us = 0;
    log.write(reinterpret_cast<const char*>(&count), sizeof(count));
    log.write(reinterpret_cast<const char*>(&stamp_us), sizeof(stamp_us));
    log.write(reinterpret_cast<const char*>(bytes), sizeof(bytes));
    log << std::string(static_cast<std::size_t>(bytes[0]), '\4');
    log.close();
    const Result<CheckedSource> checked = OpenCheckedSource(request, RunConfig());
    ASSERT_TRUE(checked.ok()) << checked.message();
    EXPECT_EQ(checked.value().messages,
              std::vector<std::string>{
                  "no camera.yaml, and the focal length cannot be estimated from this recording: "
                  "assuming a Kinect's focal length, fx 528.0"});
}

TEST(OpenCheckedSource, TakesTheErrorsFromDepth) {
    const TempFolder folder;
    std::vector<Frame> frames;
    for (int i = 0; i < 50; ++i) frames.push_back(painted_room::DistortedView(i));
    CameraCalibration camera;
    camera.pinhole = painted_room::kCamera;
    camera.depth_scale = 1000;
    WriteViews(folder, frames, camera);
    RunRequest request;
    request.source = folder.path();
    for (const bool check : {true, false}) {
        RunConfig config;
        config.check_camera = check;
        const Result<CheckedSource> checked = OpenCheckedSource(request, config);
        ASSERT_TRUE(checked.ok()) << checked.message();
        Frame frame;
        ASSERT_TRUE(checked.value().source->Seek(5));
        ASSERT_EQ(checked.value().source->Read(frame).status, ReadStatus::kOk);
        const Frame truth = painted_room::View(5, 0);
        double square_m2 = 0;
        for (std::size_t i = 0; i < truth.depth_m.size(); ++i)
            square_m2 += std::pow(frame.depth_m.data()[i] - truth.depth_m.data()[i], 2);
        const double rms_m = std::sqrt(square_m2 / static_cast<double>(truth.depth_m.size()));
        if (check) {
            ASSERT_TRUE(checked.value().found.depth_distortion);
            EXPECT_TRUE(checked.value().found.depth_distortion->used);
            ASSERT_EQ(checked.value().messages.size(), 1u);
            EXPECT_NE(checked.value().messages[0].find("wrong at 1 m"), std::string::npos);
            EXPECT_LT(rms_m, 0.006);
        } else {
            EXPECT_FALSE(checked.value().found.depth_distortion);
            EXPECT_GT(rms_m, 0.015);
        }
    }
}

}  // namespace
}  // namespace tessera
