#include "run/calibrate.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <opencv2/imgproc.hpp>

#include "io/image_io.h"
#include "support/temp_folder.h"

namespace tessera {
namespace {

constexpr PinholeCamera kTrueCamera{320, 240, 262, 264, 157.3, 121.8};
constexpr LensDistortion kTrueLens{0.12, -0.2, 0.002, -0.0015, 0.05};
constexpr int kCell_px = 30;  // of a square in Svg()

// The board as pixels, from the rectangles that a printer would get. White around it.
Image<std::uint8_t> Printed(const CalibrationBoard& board) {
    const std::string svg = board.Svg();
    Image<std::uint8_t> pixels(board.columns * kCell_px, board.rows * kCell_px, 255);
    for (std::size_t at = svg.find("<path"); (at = svg.find('M', at)) != std::string::npos; ++at) {
        int x = 0, y = 0, width = 0;
        EXPECT_EQ(std::sscanf(svg.c_str() + at, "M%d %dh%dv1H", &x, &y, &width), 3);
        for (int i = x; i < x + width; ++i) pixels(i, y) = 0;
    }
    return pixels;
}

// The direction (x / z, y / z) that the lens shows at a pixel: Brown and Conrady's model inverted
// by iteration.
Eigen::Vector2d IdealDirection(double u, double v) {
    const LensDistortion& d = kTrueLens;
    const double xd = (u - kTrueCamera.cx) / kTrueCamera.fx,
                 yd = (v - kTrueCamera.cy) / kTrueCamera.fy;
    double x = xd, y = yd;
    for (int i = 0; i < 30; ++i) {
        const double r2 = x * x + y * y, radial = 1 + r2 * (d.k1 + r2 * (d.k2 + r2 * d.k3));
        const double dx = 2 * d.p1 * x * y + d.p2 * (r2 + 2 * x * x),
                     dy = d.p1 * (r2 + 2 * y * y) + 2 * d.p2 * x * y;
        x = (xd - dx) / radial;
        y = (yd - dy) / radial;
    }
    return {x, y};
}

constexpr int kFine = 3;  // samples in a row of a pixel

// Of each sample of each pixel.
const std::vector<Eigen::Vector2d>& IdealDirections() {
    static const std::vector<Eigen::Vector2d> directions = [] {
        std::vector<Eigen::Vector2d> all;
        for (int y = 0; y < kTrueCamera.height; ++y)
            for (int x = 0; x < kTrueCamera.width; ++x)
                for (int s = 0; s < kFine * kFine; ++s)
                    all.push_back(
                        IdealDirection(x + (s % kFine - 1) / 3.0, y + (s / kFine - 1) / 3.0));
        return all;
    }();
    return directions;
}

// A view of the board; depth is its true distance times `depth_share`.
Frame BoardFrame(const CalibrationBoard& board, const Image<std::uint8_t>& printed,
                 const Eigen::Isometry3d& T_camera_board, double depth_share) {
    Frame frame;
    frame.colour.Resize(kTrueCamera.width, kTrueCamera.height);
    frame.depth_m.Resize(kTrueCamera.width, kTrueCamera.height);
    const Eigen::Isometry3d T_board_camera = T_camera_board.inverse();
    const Eigen::Vector3d origin = T_board_camera.translation();
    auto sample = IdealDirections().begin();
    for (int y = 0; y < kTrueCamera.height; ++y)
        for (int x = 0; x < kTrueCamera.width; ++x) {
            int sum = 0;
            for (int s = 0; s < kFine * kFine; ++s) {
                const Eigen::Vector2d& ray = *sample++;
                const Eigen::Vector3d direction =
                    T_board_camera.linear() * Eigen::Vector3d(ray.x(), ray.y(), 1);
                const double z = -origin.z() / direction.z();
                if (s == kFine * kFine / 2)
                    frame.depth_m(x, y) = static_cast<float>(depth_share * z);
                const Eigen::Vector3d p = origin + z * direction;
                const int i = static_cast<int>(std::floor(p.x() / board.square_m * kCell_px)),
                          j = static_cast<int>(std::floor(p.y() / board.square_m * kCell_px));
                sum += printed.Contains(i, j) ? printed(i, j) : 255;
            }
            const auto grey = static_cast<std::uint8_t>(sum / (kFine * kFine));
            frame.colour(x, y) = {grey, grey, grey};
        }
    return frame;
}

// Poses that show the board in all parts of the image, tilted to all sides.
std::vector<Eigen::Isometry3d> BoardPoses() {
    std::vector<Eigen::Isometry3d> poses;
    for (int i = 0; i < 16; ++i) {
        const double a = i * 2.4, tilt = 0.25 + 0.03 * i;
        Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
        T.linear() = Eigen::AngleAxisd(tilt, Eigen::Vector3d(std::cos(a), std::sin(a), 0))
                         .toRotationMatrix() *
                     Eigen::AngleAxisd(0.3 * i, Eigen::Vector3d::UnitZ()).toRotationMatrix();
        const double z = 0.32 + 0.02 * (i % 5);
        const Eigen::Vector3d middle(0.32 * z * std::cos(a + 1), 0.22 * z * std::sin(a + 1), z);
        T.translation() = middle - T.linear() * Eigen::Vector3d(0.09, 0.126, 0);
        poses.push_back(T);
    }
    return poses;
}

TEST(CalibrationBoard, EveryCornerOfAPrintIsFound) {
    const CalibrationBoard board;
    const Image<std::uint8_t> printed = Printed(board);
    constexpr int kScale = 2, kBorder = 80;
    ColourImage image(kScale * printed.width() + 2 * kBorder,
                      kScale * printed.height() + 2 * kBorder, {255, 255, 255});
    for (int y = 0; y < kScale * printed.height(); ++y)
        for (int x = 0; x < kScale * printed.width(); ++x) {
            const std::uint8_t grey = printed(x / kScale, y / kScale);
            image(x + kBorder, y + kBorder) = {grey, grey, grey};
        }
    // As a lens would show it. Corners of pixels that are black or white are off by half a pixel.
    cv::Mat pixels(image.height(), image.width(), CV_8UC3, image.data());
    cv::GaussianBlur(pixels, pixels, cv::Size(), 1.0);
    const BoardView view = FindBoard(board, image);
    const std::vector<Eigen::Vector3d> corners = board.Corners();
    ASSERT_EQ(view.ids.size(), 24u);
    for (std::size_t i = 0; i < view.ids.size(); ++i) {
        const Eigen::Vector3d& p = corners[static_cast<std::size_t>(view.ids[i])];
        const Eigen::Vector2d expected = p.head<2>() / board.square_m * kCell_px * kScale +
                                         Eigen::Vector2d::Constant(kBorder - 0.5);
        EXPECT_LT((view.pixels[i] - expected).norm(), 0.05);
    }
    EXPECT_TRUE(FindBoard(board, ColourImage(320, 240, {128, 128, 128})).ids.empty());
    EXPECT_NE(board.Svg().find("width=\"180mm\" height=\"252mm\""), std::string::npos);
}

TEST(CameraCalibrator, FindsCameraLensAndDepthUnit) {
    const CalibrationBoard board;
    const Image<std::uint8_t> printed = Printed(board);
    CameraCalibrator calibrator(board);
    int kept = 0;
    for (const Eigen::Isometry3d& T_camera_board : BoardPoses()) {
        const Frame frame = BoardFrame(board, printed, T_camera_board, 0.98);
        kept += calibrator.Add(frame);
        EXPECT_FALSE(calibrator.Add(frame)) << "the same view again";
    }
    EXPECT_GE(kept, 12);
    EXPECT_GT(calibrator.coverage(), 0.7);
    const auto result = calibrator.Solve(1000);
    ASSERT_TRUE(result.ok()) << result.message();
    const CalibrationResult& r = result.value();
    EXPECT_LT(r.rms_px, 0.2);
    const PinholeCamera& found = r.calibration.pinhole;
    EXPECT_NEAR(found.fx, kTrueCamera.fx, 1);
    EXPECT_NEAR(found.fy, kTrueCamera.fy, 1);
    EXPECT_NEAR(found.cx, kTrueCamera.cx, 1);
    EXPECT_NEAR(found.cy, kTrueCamera.cy, 1);
    EXPECT_NEAR(found.fx, kTrueCamera.fx, 5 * r.fx_sigma_px);
    EXPECT_GT(r.fx_sigma_px, 0.01);
    // The lens as a whole, in a corner of the image: its coefficients make up for each other.
    EXPECT_NEAR(r.calibration.distortion.k1, kTrueLens.k1, 0.03);
    ASSERT_TRUE(r.depth_factor.has_value());
    EXPECT_NEAR(*r.depth_factor, 1 / 0.98, 5 * r.depth_factor_sigma);
    EXPECT_LT(r.depth_factor_sigma, 0.005);
    EXPECT_NEAR(r.calibration.depth_scale, 980, 4);
}

TEST(CalibrateCamera, ReadsAFolderAndSaysWhatIsMissing) {
    const CalibrationBoard board;
    const Image<std::uint8_t> printed = Printed(board);
    const TempFolder folder;
    std::filesystem::create_directories(folder / "rgb");
    std::filesystem::create_directories(folder / "depth");
    std::ofstream(folder / "camera.yaml")
        << "width: 320\nheight: 240\nfx: 300\nfy: 300\ncx: 160\ncy: 120\n"
           "distortion: [0.3, 0, 0, 0, 0]\ndepth_scale: 1000\n";
    const std::vector<Eigen::Isometry3d> poses = BoardPoses();
    const auto write = [&](std::size_t i) {
        const Frame frame = BoardFrame(board, printed, poses[i], 1);
        const std::string name = "/" + std::to_string(100 + i) + ".png";
        Image<std::uint16_t> depth;
        StoreDepth(frame.depth_m, 1000, depth);
        ASSERT_TRUE(WriteColourImage(folder / "rgb" + name, frame.colour).ok());
        ASSERT_TRUE(WriteDepthImage(folder / "depth" + name, depth).ok());
    };
    for (std::size_t i = 0; i < 5; ++i) write(i);
    CalibrateRequest request{folder.path(), board, nullptr, {}};
    EXPECT_NE(CalibrateCamera(request, {})
                  .message()
                  .find(": the board was seen in 5 different views; at least 10 are needed"),
              std::string::npos);
    for (std::size_t i = 5; i < poses.size(); ++i) write(i);
    int views = 0;
    request.on_view = [&views](const CameraCalibrator&) { ++views; };
    const auto result = CalibrateCamera(request, {});
    ASSERT_TRUE(result.ok()) << result.message();
    EXPECT_GE(views, 12);
    EXPECT_NEAR(result.value().result.calibration.pinhole.fx, kTrueCamera.fx, 1);
    EXPECT_NEAR(result.value().result.calibration.depth_scale, 1000, 4);
}

}  // namespace
}  // namespace tessera
