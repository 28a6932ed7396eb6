// One chart: a frame with ticks, labels and curves, drawn with OpenCV. Used by plot.cpp only.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <string>
#include <vector>

#include "core/image.h"

namespace cv {
class Mat;
}

namespace tessera {

// Charts are drawn this many times larger and then scaled down, for smooth lines and text.
inline constexpr int kChartOversampling = 2;
// Colour of text and axes.
inline constexpr Rgb8 kInk{50, 54, 60};

// Draws text with the left end, centre or right end (align -1, 0, 1) of its baseline at `at`, in
// final pixels.
void DrawText(cv::Mat& canvas, const std::string& text, const Eigen::Vector2d& at, double height_px,
              int align, const Rgb8& colour);

// A rectangle of the image, in final pixels.
struct ChartArea {
    double x, y, width, height;
};

class Chart {
  public:
    struct Range {
        double low, high;
        double size() const { return high - low; }
    };

    // `area` includes the labels, in final pixels. With equal_scale, one range is widened so that
    // both axes have the same scale.
    Chart(cv::Mat& canvas, const ChartArea& area, Range x, Range y, bool equal_scale);

    void DrawFrame(const std::string& title, const std::string& x_label,
                   const std::string& y_label);
    void DrawCurve(const std::vector<Eigen::Vector2d>& points, const Rgb8& colour, double width_px);
    void DrawSegment(const Eigen::Vector2d& p, const Eigen::Vector2d& q, const Rgb8& colour,
                     double width_px);

  private:
    Eigen::Vector2d ToPixel(const Eigen::Vector2d& p) const;

    cv::Mat& canvas_;
    ChartArea area_, plot_;
    Range x_, y_;
};

}  // namespace tessera
