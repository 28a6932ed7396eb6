#include "report/report_charts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "report/page_parts.h"

namespace tessera {
namespace {

const char* StyleOf(FrameState state) {
    switch (state) {
        case FrameState::kFused: return "fused";
        case FrameState::kTracked: return "tracked";
        case FrameState::kLost: return "lost";
    }
    return "";
}

// Pieces of equal state. Where frames are closer than the chart can show, the worst is shown.
std::vector<StripPiece> StatePieces(const std::vector<FrameRow>& rows, const TimeRange& range) {
    constexpr int kColumns = 490;
    const double width_s = std::max(1e-3, range.end_s - range.begin_s) / kColumns;
    std::vector<StripPiece> pieces;
    double last_column = -1, column_begin_s = 0;
    FrameState shown = FrameState::kFused;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const double begin_s = rows[i].stamp_s - range.begin_s;
        const double column = std::floor(begin_s / width_s);
        if (column != last_column) column_begin_s = begin_s;
        const double end_s =
            i + 1 < rows.size() ? rows[i + 1].stamp_s - range.begin_s : range.end_s - range.begin_s;
        const FrameState worst =
            column == last_column ? std::max(shown, rows[i].state) : rows[i].state;
        if (!pieces.empty() && worst == shown) {
            pieces.back().end = std::max(pieces.back().end, end_s);
        } else if (!pieces.empty() && column == last_column) {
            // The piece may have begun columns before: that part of it keeps its state.
            if (pieces.back().begin < column_begin_s) {
                pieces.back().end = column_begin_s;
                pieces.emplace_back();
            }
            pieces.back() = {column_begin_s, end_s, StyleOf(worst)};
        } else {
            pieces.push_back({begin_s, end_s, StyleOf(worst)});
        }
        shown = worst;
        last_column = column;
    }
    return pieces;
}

// Consecutive frames that are lost.
std::vector<TableRow> Losses(const std::vector<FrameRow>& rows, double begin_s) {
    constexpr std::size_t kMostShown = 8;
    std::vector<TableRow> losses;
    for (std::size_t i = 0; i < rows.size();) {
        std::size_t end = i;
        while (end < rows.size() && rows[end].state == FrameState::kLost) ++end;
        if (end > i)
            losses.push_back({fmt::format("{:.2f}", rows[i].stamp_s - begin_s),
                              CountText(static_cast<std::int64_t>(end - i)), rows[i].reason});
        i = std::max(end, i + 1);
    }
    if (losses.size() > kMostShown) {
        const std::size_t more = losses.size() - kMostShown;
        losses.resize(kMostShown);
        losses.push_back({"...", "", fmt::format("{} more", more)});
    }
    return losses;
}

}  // namespace

TimeRange TimeRangeOf(const ReportData& data) {
    TimeRange range{std::numeric_limits<double>::max(), std::numeric_limits<double>::lowest()};
    const auto extend = [&](double stamp_s) {
        range = {std::min(range.begin_s, stamp_s), std::max(range.end_s, stamp_s)};
    };
    for (const StampedPose& pose : data.path) extend(pose.stamp_s);
    if (data.frames)
        for (const FrameRow& row : data.frames->rows) extend(row.stamp_s);
    return range.begin_s > range.end_s ? TimeRange{} : range;
}

ChartSpec TimeChart(const ReportData& data, const std::string& title, const std::string& y_label) {
    const TimeRange range = TimeRangeOf(data);
    ChartSpec spec;
    spec.title = title;
    spec.x_label = "seconds";
    spec.y_label = y_label;
    spec.x_high = std::max(1e-3, range.end_s - range.begin_s);
    return spec;
}

std::string TrackingSection(const ReportData& data) {
    if (!data.frames) return {};
    const std::vector<FrameRow>& rows = data.frames->rows;
    const TimeRange range = TimeRangeOf(data);
    std::array<std::int64_t, 3> count{};
    std::int64_t degenerate = 0;
    ChartSpec fits = TimeChart(data, "Share of each frame's points that fit the map", "% that fit");
    ChartSeries& curve = fits.series.emplace_back(ChartSeries{"points that fit", "c1", {}});
    fits.y_high = 105;
    for (const FrameRow& row : rows) {
        ++count[static_cast<std::size_t>(row.state)];
        degenerate += row.degenerate;
        // The first frame makes the map: there is nothing yet that it could fit.
        if (&row != &rows.front())
            curve.points.emplace_back(row.stamp_s - range.begin_s, 100 * row.inlier_fraction);
    }
    const auto line = [&](const char* name, std::int64_t n) {
        return TableRow{name, CountText(n),
                        PercentText(static_cast<double>(n), static_cast<double>(rows.size()))};
    };
    std::string aside =
        TableHtml({"", "frames", ""}, {line("fused", count[0]),
                                       line("tracked, not fused", count[1]), line("lost", count[2]),
                                       line("degenerate (some motion hardly seen)", degenerate)});
    const std::vector<TableRow> losses = Losses(rows, range.begin_s);
    if (!losses.empty()) aside += TextTableHtml({"at, s", "lost frames", "reason"}, losses);
    const ChartSpec axis = TimeChart(data, "State of tracking over time", "");
    return SectionHtml("tracking", "Tracking",
                       "<p class=\"legend\"><span><i class=\"fused\"></i>fused</span><span><i "
                       "class=\"tracked\"></i>tracked, not fused</span><span><i class=\"lost\">"
                       "</i>lost</span></p>\n" +
                           StripSvg(axis, StatePieces(rows, range)) +
                           "<h3>Points that fit the map</h3>\n" + ChartSvg(fits),
                       aside);
}

std::string ErrorSection(const ReportData& data) {
    const auto table = [](double rmse, double mean, double median, double max, std::size_t pairs) {
        return std::vector<TableRow>{{"RMSE", LengthText(rmse)},
                                     {"mean", LengthText(mean)},
                                     {"median", LengthText(median)},
                                     {"largest", LengthText(max)},
                                     {"poses compared", CountText(static_cast<int>(pairs))}};
    };
    constexpr const char* kProtocol =
        "Distance of each position from the true path, after one rigid alignment (SE(3), no scale) "
        "of the whole path.";
    if (!data.ate) {
        if (!data.record || !data.record->ate) return {};
        const RunRecord::Ate& ate = *data.record->ate;
        return SectionHtml("error", "Error against ground truth", ParagraphHtml(kProtocol),
                           TableHtml({}, table(ate.rmse_m, ate.mean_m, ate.median_m, ate.max_m,
                                               static_cast<std::size_t>(ate.pairs))));
    }
    const AteResult& ate = *data.ate;
    const bool small = ate.error_m.max < 0.01;
    const double unit_m = small ? 0.001 : 0.01;
    ChartSpec chart =
        TimeChart(data, "Absolute trajectory error over time", small ? "error, mm" : "error, cm");
    ChartSeries& curve = chart.series.emplace_back(ChartSeries{"error", "c1", {}});
    chart.y_high = std::max(1e-9, kChartHeadroom * ate.error_m.max / unit_m);
    const double begin_s = TimeRangeOf(data).begin_s;
    for (const AteResult::Pair& pair : ate.pairs)
        curve.points.emplace_back(pair.stamp_s - begin_s, pair.error_m / unit_m);
    std::vector<TableRow> rows = table(ate.error_m.rmse, ate.error_m.mean, ate.error_m.median,
                                       ate.error_m.max, ate.pairs.size());
    if (data.rpe) {
        rows.push_back({"drift in 1 s (RMSE)", LengthText(data.rpe->trans_m.rmse)});
        rows.push_back(
            {"turn in 1 s (RMSE)",
             fmt::format("{:.3f} deg", data.rpe->rot_rad.rmse * 180 / std::numbers::pi)});
    }
    std::string body = ParagraphHtml(kProtocol) + ChartSvg(chart);
    if (!ate.warning.empty()) body += ParagraphHtml(ate.warning);
    return SectionHtml("error", "Error against ground truth", body,
                       TableHtml({}, rows) + ParagraphHtml("Ground truth: " + data.truth));
}

std::vector<Correction> CorrectionsOf(const std::vector<StampedPose>& tracked,
                                      const std::vector<StampedPose>& corrected) {
    constexpr double kSame_s = 1e-5;
    std::vector<Correction> corrections;
    auto before = tracked.begin();
    for (const StampedPose& after : corrected) {
        while (before != tracked.end() && before->stamp_s < after.stamp_s - kSame_s) ++before;
        if (before == tracked.end()) break;
        if (before->stamp_s > after.stamp_s + kSame_s) continue;
        const Eigen::Vector3d moved =
            after.T_world_camera.translation() - before->T_world_camera.translation();
        corrections.push_back({after.stamp_s, moved.norm()});
    }
    return corrections;
}

std::string CorrectionSection(const ReportData& data) {
    const std::vector<Correction> corrections = CorrectionsOf(data.tracked_path, data.path);
    if (corrections.empty()) return {};
    ChartSpec chart = TimeChart(data, "How far loop closure moved each pose", "moved, cm");
    ChartSeries& curve = chart.series.emplace_back(ChartSeries{"moved", "c2", {}});
    const double begin_s = TimeRangeOf(data).begin_s;
    double sum_m = 0, max_m = 0;
    for (const Correction& c : corrections) {
        curve.points.emplace_back(c.stamp_s - begin_s, 100 * c.distance_m);
        sum_m += c.distance_m;
        max_m = std::max(max_m, c.distance_m);
    }
    chart.y_high = std::max(1e-9, kChartHeadroom * 100 * max_m);
    const double mean_m = sum_m / static_cast<double>(corrections.size());
    return SectionHtml(
        "loops", "Loop closure",
        ParagraphHtml("Where the path returned to a place, path and model were corrected. The grey "
                      "line in the model is the path before its correction.") +
            ChartSvg(chart),
        TableHtml({}, {{"poses moved by (mean)", LengthText(mean_m)},
                       {"poses moved by (most)", LengthText(max_m)},
                       {"poses", CountText(static_cast<std::int64_t>(corrections.size()))}}));
}

}  // namespace tessera
