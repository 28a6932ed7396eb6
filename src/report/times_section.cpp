#include <algorithm>
#include <array>

#include "report/page_parts.h"
#include "report/report_charts.h"

namespace tessera {
namespace {

struct StageColumn {
    const char *name, *style;
    double FrameRow::*value;
};
constexpr std::array kShownTimes{StageColumn{"whole frame", "c0", &FrameRow::frame_ms},
                                 StageColumn{"track", "c1", &FrameRow::track_ms},
                                 StageColumn{"fuse", "c2", &FrameRow::fuse_ms}};

// What timings.json would say, as far as frames.csv knows it.
std::vector<RunTimes::Stage> StagesOf(const std::vector<FrameRow>& rows) {
    std::vector<RunTimes::Stage> stages;
    for (const auto& [name, style, value] : kShownTimes) {
        std::vector<double> times;
        for (const FrameRow& row : rows) times.push_back(row.*value);
        std::ranges::sort(times);
        const std::size_t last = times.size() - 1;
        double sum = 0;
        for (const double time : times) sum += time;
        stages.push_back({name, sum / static_cast<double>(times.size()),
                          (times[last / 2] + times[(last + 1) / 2]) / 2, times[last * 95 / 100],
                          times[last]});
    }
    return stages;
}

// The highest value, or less where single frames would flatten the rest.
double TopOf(std::vector<double> values) {
    if (values.empty()) return 1;
    std::ranges::sort(values);
    const double usual = values[(values.size() - 1) * 97 / 100];
    return std::max(1e-9, std::min(values.back(), 2 * usual));
}

}  // namespace

std::string TimesSection(const ReportData& data) {
    std::string body, aside;
    if (data.frames) {
        ChartSpec chart = TimeChart(data, "Time per frame", "ms");
        std::vector<double> whole;
        for (const FrameRow& row : data.frames->rows) whole.push_back(row.frame_ms);
        chart.y_high = kChartHeadroom * TopOf(whole);
        const double begin_s = TimeRangeOf(data).begin_s;
        for (const StageColumn& column : kShownTimes) {
            ChartSeries& curve =
                chart.series.emplace_back(ChartSeries{column.name, column.style, {}});
            for (const FrameRow& row : data.frames->rows)
                curve.points.emplace_back(row.stamp_s - begin_s, row.*column.value);
        }
        body = ChartSvg(chart);
        const auto above = std::ranges::count_if(whole, [&](double t) { return t > chart.y_high; });
        if (above > 0)
            body += ParagraphHtml(fmt::format("{} of {} frames took longer than the chart is high.",
                                              above, whole.size()));
    }
    const std::vector<RunTimes::Stage> stages = data.times    ? data.times->stages
                                                : data.frames ? StagesOf(data.frames->rows)
                                                              : std::vector<RunTimes::Stage>();
    if (!stages.empty()) {
        std::vector<TableRow> rows;
        for (const RunTimes::Stage& s : stages)
            rows.push_back({s.name, fmt::format("{:.1f}", s.median_ms),
                            fmt::format("{:.1f}", s.mean_ms), fmt::format("{:.1f}", s.p95_ms),
                            fmt::format("{:.1f}", s.max_ms)});
        aside = TableHtml({"ms", "median", "mean", "95 %", "max"}, rows);
        aside += ParagraphHtml(
            "The whole frame is from one frame's completion to the next, waiting for its decoding "
            "included.");
    }
    if (body.empty() && aside.empty()) return {};
    return body.empty() ? SectionHtml("times", "Time per frame", aside)
                        : SectionHtml("times", "Time per frame", body, aside);
}

}  // namespace tessera
