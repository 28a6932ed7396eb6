#include "report/page_parts.h"

#include <fmt/format.h>

#include <cmath>

#include "report/page_text.h"

namespace tessera {
namespace {

std::string Row(const TableRow& cells, const char* tag) {
    std::string html = "<tr>";
    for (const std::string& cell : cells)
        html += fmt::format("<{0}>{1}</{0}>", tag, EscapeHtml(cell));
    return html + "</tr>\n";
}

std::string Table(const char* style, const TableRow& header, const std::vector<TableRow>& rows) {
    std::string html = fmt::format("<div class=\"scroll\"><table class=\"{}\">\n", style);
    if (!header.empty()) html += "<thead>" + Row(header, "th") + "</thead>\n";
    html += "<tbody>\n";
    for (const TableRow& row : rows) html += Row(row, "td");
    return html + "</tbody></table></div>\n";
}

}  // namespace

std::string TableHtml(const TableRow& header, const std::vector<TableRow>& rows) {
    return Table("numbers", header, rows);
}

std::string TextTableHtml(const TableRow& header, const std::vector<TableRow>& rows) {
    return Table("words", header, rows);
}

std::string SectionHtml(const std::string& id, const std::string& title, const std::string& body,
                        const std::string& aside) {
    std::string html =
        fmt::format("<section id=\"{}\">\n<h2>{}</h2>\n", EscapeHtml(id), EscapeHtml(title));
    if (aside.empty()) return html + body + "</section>\n";
    return html + "<div class=\"pair\">\n<div>\n" + body + "</div>\n<div>\n" + aside +
           "</div>\n</div>\n</section>\n";
}

std::string ParagraphHtml(const std::string& text) { return "<p>" + EscapeHtml(text) + "</p>\n"; }

std::string LengthText(double metres) {
    const double size = std::abs(metres);
    if (size < 0.01) return fmt::format("{:.2f} mm", 1000 * metres);
    if (size < 1) return fmt::format("{:.1f} cm", 100 * metres);
    return size < 100 ? fmt::format("{:.2f} m", metres) : fmt::format("{:.0f} m", metres);
}

std::string DurationText(double seconds) {
    if (seconds < 60) return fmt::format("{:.1f} s", seconds);
    const auto whole = static_cast<std::int64_t>(std::llround(seconds));
    return fmt::format("{} min {} s", whole / 60, whole % 60);
}

std::string CountText(std::int64_t count) {
    std::string text = std::to_string(count);
    const std::size_t first = count < 0 ? 1 : 0;
    for (std::size_t i = text.size(); i > first + 3;) text.insert(i -= 3, ",");
    return text;
}

std::string PercentText(double part, double whole) {
    return whole > 0 ? fmt::format("{:.1f} %", 100 * part / whole) : std::string("-");
}

}  // namespace tessera
