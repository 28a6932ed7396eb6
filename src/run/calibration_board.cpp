#include "run/calibration_board.h"

#include <fmt/format.h>

#include <algorithm>
#include <opencv2/aruco/charuco.hpp>
#include <opencv2/imgproc.hpp>

namespace tessera {
namespace {

constexpr double kMarkerShare = 0.6;  // of a square's width

cv::Ptr<cv::aruco::CharucoBoard> CharucoOf(const CalibrationBoard& board) {
    return cv::aruco::CharucoBoard::create(
        board.columns, board.rows, static_cast<float>(board.square_m),
        static_cast<float>(kMarkerShare * board.square_m),
        cv::aruco::getPredefinedDictionary(cv::aruco::DICT_4X4_100));
}

// The smallest distance between corners with consecutive numbers, which are neighbours in a row.
double SquareWidth_px(const std::vector<int>& ids, const std::vector<cv::Point2f>& corners) {
    double width_px = 1e3;
    for (std::size_t i = 0; i + 1 < ids.size(); ++i)
        if (ids[i + 1] == ids[i] + 1)
            width_px = std::min(width_px, cv::norm(corners[i + 1] - corners[i]));
    return width_px;
}

}  // namespace

std::vector<Eigen::Vector3d> CalibrationBoard::Corners() const {
    std::vector<Eigen::Vector3d> corners;
    const cv::Ptr<cv::aruco::CharucoBoard> charuco = CharucoOf(*this);
    for (const cv::Point3f& p : charuco->chessboardCorners) corners.emplace_back(p.x, p.y, p.z);
    return corners;
}

// OpenCV draws the board as pixels, with rounded edges. So it is drawn large, and each cell, of
// which a marker's bit has 3 x 3, gets the colour of its middle. Runs of black cells become
// rectangles.
std::string CalibrationBoard::Svg() const {
    constexpr int kSquare_cells = 30, kCell_px = 20;
    const int width = columns * kSquare_cells, height = rows * kSquare_cells;
    cv::Mat drawn;
    CharucoOf(*this)->draw(cv::Size(width * kCell_px, height * kCell_px), drawn);
    const auto is_black = [&](int x, int y) {
        return drawn.at<std::uint8_t>(y * kCell_px + kCell_px / 2, x * kCell_px + kCell_px / 2) <
               128;
    };
    const double mm = 1000 * square_m;
    std::string svg = fmt::format(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:g}mm\" height=\"{1:g}mm\" "
        "viewBox=\"0 "
        "0 {2} {3}\" shape-rendering=\"crispEdges\">\n<rect width=\"{2}\" height=\"{3}\" "
        "fill=\"white\"/>\n<path d=\"",
        mm * columns, mm * rows, width, height);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width;) {
            const int first = x;
            while (x < width && is_black(x, y)) ++x;
            if (x > first) svg += fmt::format("M{} {}h{}v1H{}z", first, y, x - first, first);
            if (x == first) ++x;
        }
    return svg + "\"/>\n</svg>\n";
}

// OpenCV 4.6 delivers corners that are off by half a pixel or, with its own refinement, sometimes
// at a marker's corner. The window here ends before the next marker.
BoardView FindBoard(const CalibrationBoard& board, const ColourImage& image) {
    const cv::Mat colour(image.height(), image.width(), CV_8UC3, const_cast<Rgb8*>(image.data()));
    cv::Mat grey;
    cv::cvtColor(colour, grey, cv::COLOR_RGB2GRAY);
    const auto charuco = CharucoOf(board);
    std::vector<std::vector<cv::Point2f>> markers;
    std::vector<int> marker_ids, ids;
    std::vector<cv::Point2f> corners;
    cv::aruco::detectMarkers(grey, charuco->dictionary, markers, marker_ids);
    if (marker_ids.empty()) return {};
    cv::aruco::interpolateCornersCharuco(markers, marker_ids, grey, charuco, corners, ids);
    if (ids.empty()) return {};
    const int window = std::clamp(static_cast<int>(0.15 * SquareWidth_px(ids, corners)), 2, 8);
    cv::cornerSubPix(grey, corners, cv::Size(window, window), cv::Size(-1, -1),
                     {cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 30, 0.01});
    BoardView view{ids, {}};
    for (const cv::Point2f& corner : corners) view.pixels.emplace_back(corner.x, corner.y);
    return view;
}

}  // namespace tessera
