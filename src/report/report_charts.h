// The parts of the page with charts: tracking, errors, times, correction of the path. Each is HTML,
// or empty if the run does not have it. Pure functions, thread-safe.
#pragma once

#include <string>

#include "report/report_data.h"
#include "report/svg_chart.h"

namespace tessera {

// The stamps of the first and last frame or pose.
struct TimeRange {
    double begin_s = 0, end_s = 0;
};
TimeRange TimeRangeOf(const ReportData& data);

// A chart over all of that time, in seconds from its begin, without curves.
ChartSpec TimeChart(const ReportData& data, const std::string& title, const std::string& y_label);
inline constexpr double kChartHeadroom = 1.08;  // from the highest point to the upper edge

std::string TrackingSection(const ReportData& data);
std::string ErrorSection(const ReportData& data);
std::string TimesSection(const ReportData& data);
std::string CorrectionSection(const ReportData& data);

// How far loop closure moved the poses, by stamp.
struct Correction {
    double stamp_s = 0, distance_m = 0;
};
std::vector<Correction> CorrectionsOf(const std::vector<StampedPose>& tracked,
                                      const std::vector<StampedPose>& corrected);

}  // namespace tessera
