// Charts as inline SVG. Colours come from the page's style sheet by class names. Pure functions,
// thread-safe.
#pragma once

#include <Eigen/Core>
#include <string>
#include <utility>
#include <vector>

namespace tessera {

struct ChartSeries {
    std::string name;                     // for the legend
    std::string style;                    // class of the style sheet
    std::vector<Eigen::Vector2d> points;  // ascending in x
};

struct ChartSpec {
    std::string title;  // what it shows, for screen readers
    std::string x_label, y_label;
    double x_low = 0, x_high = 1;
    std::vector<ChartSeries> series;
    // y starts at 0. Values above are cut off and the curve runs along the upper edge.
    double y_high = 1;
};

std::string ChartSvg(const ChartSpec& spec);

// A bar along x, in which each piece (begin, end) has its class's colour.
struct StripPiece {
    double begin = 0, end = 0;
    std::string style;
};
std::string StripSvg(const ChartSpec& axis, const std::vector<StripPiece>& pieces);

// Round numbers (1, 2 or 5 times a power of ten apart) within [low, high]: at most `most` (two or
// more). None if the range is empty.
std::vector<double> RoundTicks(double low, double high, int most);

// At most two points (lowest, highest) in each of `columns` equal parts of [low, high].
std::vector<Eigen::Vector2d> ThinnedCurve(const std::vector<Eigen::Vector2d>& points, double low,
                                          double high, int columns);

}  // namespace tessera
