#include "render/annotation.h"

#include <algorithm>
#include <opencv2/imgproc.hpp>

#include "core/check.h"

namespace tessera {
namespace {

constexpr int kFont = cv::FONT_HERSHEY_SIMPLEX;

cv::Mat Canvas(ColourImage& image) {
    return {image.height(), image.width(), CV_8UC3, image.data()};
}

cv::Scalar ToScalar(const Rgb8& c) { return {double(c.r), double(c.g), double(c.b)}; }

int Thickness(const ColourImage& image) { return std::max(1, image.width() / 1000); }

}  // namespace

PictureSheet::PictureSheet(int columns, int rows, int width, int height)
    : width_(width), height_(height), image_(columns * width, rows * height) {}

void PictureSheet::Put(int column, int row, const std::string& title, const ColourImage& tile) {
    TESSERA_CHECK(tile.width() == width_ && tile.height() == height_,
                  "a tile of {} x {} on a sheet of {} x {}", tile.width(), tile.height(), width_,
                  height_);
    for (int v = 0; v < height_; ++v)
        std::copy_n(tile.row(v), width_, image_.row(row * height_ + v) + column * width_);
    const cv::Point at(column * width_ + 8, row * height_ + 22);
    cv::putText(Canvas(image_), title, at, kFont, 0.6, {0, 0, 0}, 4, cv::LINE_AA);
    cv::putText(Canvas(image_), title, at, kFont, 0.6, {255, 255, 255}, 1, cv::LINE_AA);
}

void DrawPlate(int middle, int bottom, const std::string& text, const Rgb8& colour,
               ColourImage& image) {
    const double scale = 0.45 * std::max(1.0, image.width() / 1280.0);
    const int thickness = Thickness(image);
    int below = 0;
    const cv::Size size = cv::getTextSize(text, kFont, scale, thickness, &below);
    const cv::Point at(middle - size.width / 2, bottom - below - 3);
    const bool dark = 0.299 * colour.r + 0.587 * colour.g + 0.114 * colour.b < 140;
    cv::rectangle(Canvas(image), {at.x - 3, at.y - size.height - 3},
                  {at.x + size.width + 3, at.y + below + 1}, ToScalar(colour), cv::FILLED);
    cv::putText(Canvas(image), text, at, kFont, scale, cv::Scalar::all(dark ? 255 : 0), thickness,
                cv::LINE_AA);
}

void DrawRectangle(int x_min, int y_min, int x_max, int y_max, const Rgb8& colour,
                   ColourImage& image) {
    cv::rectangle(Canvas(image), {x_min, y_min}, {x_max, y_max}, ToScalar(colour),
                  2 * Thickness(image));
}

}  // namespace tessera
