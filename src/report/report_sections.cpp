#include "report/report_sections.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <charconv>
#include <filesystem>
#include <map>

#include "core/path_length.h"
#include "core/printable.h"
#include "report/page_parts.h"
#include "report/page_text.h"
#include "report/report_charts.h"

namespace tessera {
namespace {

std::string Tile(const std::string& value, const std::string& name, const std::string& more = {}) {
    return fmt::format("<div><b>{}</b><span>{}</span><small>{}</small></div>\n", EscapeHtml(value),
                       EscapeHtml(name), EscapeHtml(more));
}

std::string FrameTiles(const RunRecord& record) {
    const auto frames = record.Count("frames"), tracked = record.Count("tracked");
    if (!frames || !tracked) return {};
    return Tile(PercentText(static_cast<double>(*tracked), static_cast<double>(*frames)), "tracked",
                CountText(*tracked) + " of " + CountText(*frames) + " frames");
}

std::string ErrorTile(const ReportData& data) {
    if (data.ate)
        return Tile(LengthText(data.ate->error_m.rmse), "error of the path", "RMSE, SE(3) aligned");
    if (data.record && data.record->ate)
        return Tile(LengthText(data.record->ate->rmse_m), "error of the path",
                    "RMSE, SE(3) aligned");
    return {};
}

std::string ModelTile(const TriangleMesh& shown, std::size_t points, std::size_t triangles) {
    if (shown.vertices.empty()) return {};
    Eigen::AlignedBox3f box;
    for (const Eigen::Vector3f& p : shown.vertices)
        if (p.allFinite()) box.extend(p);
    const Eigen::Vector3f size =
        box.isEmpty() ? Eigen::Vector3f(0, 0, 0) : Eigen::Vector3f(box.sizes());
    const std::string box_text =
        fmt::format("{:.1f} x {:.1f} x {:.1f} m", size.x(), size.y(), size.z());
    if (triangles == 0)
        return Tile(CountText(static_cast<std::int64_t>(points)), "points", box_text);
    return Tile(CountText(static_cast<std::int64_t>(triangles)), "triangles", box_text);
}

bool SameValue(const std::string& a, const std::string& b) {
    double x = 0, y = 0;
    const auto number = [](const std::string& text, double& value) {
        const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
        return error == std::errc() && end == text.data() + text.size();
    };
    return a == b || (number(a, x) && number(b, y) && x == y);
}

}  // namespace

std::string SubtitleHtml(const ReportData& data) {
    std::string html;
    const auto add = [&](const std::string& text, const char* style) {
        if (!text.empty())
            html += fmt::format("<span class=\"{}\">{}</span>", style, EscapeHtml(text));
    };
    if (data.record) {
        add(data.record->exit, data.record->exit == "finished" ? "chip good" : "chip bad");
        add(data.record->source_kind, "chip");
        if (const auto& camera = data.record->camera)
            add(fmt::format("{} x {}", camera->width, camera->height), "chip");
        add(data.record->source_name, "path");
    } else {
        add(data.folder, "path");
    }
    return html;
}

std::string TilesHtml(const ReportData& data, const TriangleMesh& shown, std::size_t points,
                      std::size_t triangles) {
    std::string tiles;
    if (data.record) tiles += FrameTiles(*data.record);
    if (data.path.size() > 1) {
        const TimeRange range = TimeRangeOf(data);
        tiles += Tile(LengthText(PathLength_m(data.path)), "camera path",
                      "in " + DurationText(range.end_s - range.begin_s));
    }
    tiles += ErrorTile(data);
    tiles += ModelTile(shown, points, triangles);
    if (!data.objects.empty())
        tiles +=
            Tile(CountText(static_cast<std::int64_t>(data.objects.size())), "objects", "labelled");
    if (data.times && data.times->fps > 0)
        tiles += Tile(fmt::format("{:.1f}", data.times->fps), "frames per second",
                      "in " + DurationText(data.times->wall_s));
    if (data.times && data.times->peak_rss_mb > 0)
        tiles += Tile(fmt::format("{:.0f} MB", data.times->peak_rss_mb), "memory at most",
                      fmt::format("map {:.0f} MB", data.times->map_mb));
    return tiles;
}

std::string ObjectsSection(const ReportData& data) {
    if (data.objects.empty()) return {};
    std::string rows;
    for (const MapObject& o : data.objects)
        rows += fmt::format(
            "<tr data-object=\"{}\" tabindex=\"0\"><td><i style=\"background:rgb({} {} {})\"></i>"
            "{}</td><td>{}</td><td>{:.0f} %</td><td>{}</td><td>{:.2f} x {:.2f} x {:.2f}</td>"
            "</tr>\n",
            o.id, o.colour.r, o.colour.g, o.colour.b, EscapeHtml(o.class_name), o.id,
            100 * o.probability, o.observations, o.oriented_size.x(), o.oriented_size.y(),
            o.oriented_size.z());
    return SectionHtml(
        "objects", "Objects",
        "<p>Choose one to see it in the model.</p>\n<div class=\"scroll\"><table class=\"numbers\">"
        "<thead><tr><th>class</th><th>number</th><th>probability</th><th>seen</th><th>size, m</th>"
        "</tr></thead>\n<tbody>\n" +
            rows + "</tbody></table></div>\n");
}

std::vector<ChangedSetting> ChangedSettings(const RunRecord& record,
                                            const std::vector<KnownSetting>& known) {
    std::map<std::string, const KnownSetting*> by_key;
    for (const KnownSetting& setting : known) by_key[setting.key] = &setting;
    std::vector<ChangedSetting> changed;
    for (const auto& [key, value] : record.configuration) {
        const auto found = by_key.find(key);
        if (found == by_key.end()) {
            changed.push_back({key, value, "unknown to this version"});
            continue;
        }
        const KnownSetting& setting = *found->second;
        if (SameValue(value, setting.default_value)) continue;
        const std::string unit = setting.unit.empty() ? "" : " " + setting.unit;
        changed.push_back({key, value + unit,
                           setting.default_value.empty() ? "empty" : setting.default_value + unit});
    }
    return changed;
}

std::string SettingsSection(const ReportData& data, const ReportOptions& options) {
    if (!data.record || options.settings.empty()) return {};
    const auto changed = ChangedSettings(*data.record, options.settings);
    if (changed.empty())
        return SectionHtml("settings", "Settings",
                           ParagraphHtml(fmt::format("All {} settings have their default values.",
                                                     data.record->configuration.size())));
    std::vector<TableRow> rows;
    for (const ChangedSetting& s : changed) rows.push_back({s.key, s.value, s.default_value});
    return SectionHtml("settings", "Settings that differ from the defaults",
                       TextTableHtml({"setting", "this run", "default"}, rows));
}

std::string AgainSection(const ReportData& data, const ReportOptions& options) {
    if (!data.record) return {};
    std::vector<std::string> words = data.record->command_line;
    if (!words.empty()) words.front() = std::filesystem::path(words.front()).filename().string();
    std::string body;
    if (!words.empty()) body = "<pre tabindex=\"0\">" + EscapeHtml(ShellLine(words)) + "</pre>\n";
    for (const std::string& warning : data.record->warnings)
        body += ParagraphHtml("The source warned: " + warning);
    return SectionHtml("again", "Make it again", body,
                       TextTableHtml({}, {{"run by", "tessera " + data.record->version},
                                          {"page by", "tessera " + options.version},
                                          {"folder", data.folder}}));
}

namespace {

std::string Lines(const std::vector<std::string>& lines) {
    std::string html = "<ul>\n";
    for (const std::string& line : lines) html += "<li>" + EscapeHtml(line) + "</li>\n";
    return html + "</ul>\n";
}

}  // namespace

std::string DamageSection(const ReportData& data) {
    if (data.damaged.empty()) return {};
    return SectionHtml("damaged", "Not everything could be read", Lines(data.damaged));
}

std::string LeftOutSection(const ReportData& data) {
    if (data.left_out.empty()) return {};
    return SectionHtml("left-out", "What this page does not show", Lines(data.left_out));
}

}  // namespace tessera
