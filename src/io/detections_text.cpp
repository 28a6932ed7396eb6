#include "io/detections_text.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "core/input_file.h"

namespace tessera {
namespace {

constexpr std::size_t kMaxDetectionBytes = std::size_t{1} << 30;
constexpr float kFarthestPixel = 1e6f;

// Returns what is wrong with the line, or an empty string.
std::string ParseRow(const std::string& line, DetectionRow& row) {
    std::istringstream words(line);
    std::string rest;
    DetectionBox& b = row.box;
    if (!(words >> row.stamp_s >> row.name >> row.probability >> b.x_min >> b.y_min >> b.x_max >>
          b.y_max) ||
        words >> rest)
        return "expected 'stamp class probability xmin ymin xmax ymax'";
    if (!std::isfinite(row.stamp_s)) return "the stamp is not finite";
    if (!(row.probability >= 0 && row.probability <= 1))
        return fmt::format("probability {} is not in [0, 1]", row.probability);
    for (const float pixel : {b.x_min, b.y_min, b.x_max, b.y_max})
        if (!(std::abs(pixel) <= kFarthestPixel))
            return fmt::format("pixel {} is out of range", pixel);
    if (b.Area() <= 0) return "the box is empty: xmax < xmin or ymax < ymin";
    return {};
}

// Returns what is wrong with the line, or an empty string.
std::string ParseComment(const std::string& line, DetectionRows& rows) {
    const auto rest_after = [&](const char* key) -> std::optional<std::string> {
        const std::string begin = std::string("# ") + key + " ";
        if (!(line + " ").starts_with(begin)) return std::nullopt;
        return (line + " ").substr(begin.size());
    };
    if (const auto text = rest_after("frame")) {
        std::istringstream words(*text);
        double stamp_s = 0;
        if (!(words >> stamp_s) || !std::isfinite(stamp_s)) return "expected '# frame STAMP'";
        rows.frames.push_back(stamp_s);
    } else if (const auto names = rest_after("classes")) {
        std::istringstream words(*names);
        if (!rows.classes) rows.classes.emplace();
        for (std::string name; words >> name;) rows.classes->insert(name);
    } else if (const auto pairs = rest_after("aliases")) {
        Result<ClassAliases> aliases = ParseAliases(*pairs);
        if (!aliases.ok()) return "aliases: " + aliases.message();
        rows.aliases = std::move(aliases.value());
    }
    return {};
}

}  // namespace

float DetectionBox::Area() const {
    const float width = x_max - x_min + 1, height = y_max - y_min + 1;
    return width > 0 && height > 0 ? width * height : 0.0f;
}

float BoxOverlap(const DetectionBox& a, const DetectionBox& b) {
    const DetectionBox both{std::max(a.x_min, b.x_min), std::max(a.y_min, b.y_min),
                            std::min(a.x_max, b.x_max), std::min(a.y_max, b.y_max)};
    const float common = both.Area(), all = a.Area() + b.Area() - common;
    return all > 0 ? common / all : 0.0f;
}

Result<ClassAliases> ParseAliases(const std::string& text) {
    ClassAliases aliases;
    std::istringstream words(text);
    for (std::string word; words >> word;) {
        const std::size_t equals = std::min(word.find('='), word.size());
        const std::string from = word.substr(0, equals);
        const std::string to = equals < word.size() ? word.substr(equals + 1) : "";
        if (from.empty() || to.empty())
            return Status::Error("'" + Printable(word, kQuotedBytes) + "' is not NAME=NAME");
        aliases[from] = to;
    }
    return aliases;
}

std::string Renamed(const ClassAliases& aliases, const std::string& name) {
    const auto alias = aliases.find(name);
    return alias == aliases.end() ? name : alias->second;
}

Result<DetectionRows> ReadDetectionRows(const std::string& path) {
    const Result<std::string> text = ReadWholeFile(path, kMaxDetectionBytes);
    if (!text.ok()) return text.status();
    DetectionRows rows;
    std::istringstream lines(text.value());
    int number = 0;
    for (std::string line; std::getline(lines, line);) {
        ++number;
        std::string why;
        if (line.starts_with('#')) why = ParseComment(line, rows);
        line.resize(std::min(line.find('#'), line.size()));
        if (line.find_first_not_of(" \t\r") != std::string::npos)
            why = ParseRow(line, rows.rows.emplace_back());
        if (!why.empty()) return Status::Error(fmt::format("{}:{}: {}", path, number, why));
    }
    return rows;
}

}  // namespace tessera
