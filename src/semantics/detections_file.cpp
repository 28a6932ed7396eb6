#include "semantics/detections_file.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <sstream>

#include "io/file.h"

namespace tessera {
namespace {

constexpr std::size_t kMaxFileBytes = std::size_t{1} << 30;
constexpr double kSameTime_s = 0.002;
constexpr float kFarthestPixel = 1e6f;

// Returns what is wrong with the line, or an empty string.
std::string ParseLine(const std::string& line, double& stamp_s, Detection& d) {
    std::istringstream words(line);
    std::string rest;
    DetectionBox& b = d.box;
    if (!(words >> stamp_s >> d.name >> d.probability >> b.x_min >> b.y_min >> b.x_max >>
          b.y_max) ||
        words >> rest)
        return "expected 'stamp class probability xmin ymin xmax ymax'";
    if (!std::isfinite(stamp_s)) return "the stamp is not finite";
    if (!(d.probability >= 0 && d.probability <= 1))
        return fmt::format("probability {} is not in [0, 1]", d.probability);
    for (const float pixel : {b.x_min, b.y_min, b.x_max, b.y_max})
        if (!(std::abs(pixel) <= kFarthestPixel))
            return fmt::format("pixel {} is out of range", pixel);
    if (b.Area() <= 0) return "the box is empty: xmax < xmin or ymax < ymin";
    return {};
}

}  // namespace

Result<std::unique_ptr<DetectionsFile>> DetectionsFile::Read(const std::string& path) {
    const Result<std::string> text = ReadWholeFile(path, kMaxFileBytes);
    if (!text.ok()) return text.status();
    auto file = std::make_unique<DetectionsFile>();
    std::set<std::string> names;
    std::istringstream lines(text.value());
    int number = 0;
    for (std::string line; std::getline(lines, line);) {
        ++number;
        line.resize(std::min(line.find('#'), line.size()));
        if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
        double stamp_s = 0;
        Detection detection;
        if (const std::string why = ParseLine(line, stamp_s, detection); !why.empty())
            return Status::Error(fmt::format("{}:{}: {}", path, number, why));
        names.insert(detection.name);
        file->by_stamp_[stamp_s].push_back(std::move(detection));
    }
    if (names.empty())
        return Status::Error(path +
                             ": contains no detections; expected lines 'stamp class probability "
                             "xmin ymin xmax ymax'");
    file->names_.assign(names.begin(), names.end());
    return file;
}

Result<std::vector<Detection>> DetectionsFile::Detect(const Frame& frame) {
    for (const double stamp_s : {frame.colour_stamp_s, frame.stamp_s}) {
        const auto after = by_stamp_.lower_bound(stamp_s);
        auto nearest = after;
        if (after == by_stamp_.end() ||
            (after != by_stamp_.begin() &&
             stamp_s - std::prev(after)->first < after->first - stamp_s))
            nearest = after == by_stamp_.begin() ? by_stamp_.end() : std::prev(after);
        if (nearest != by_stamp_.end() && std::abs(nearest->first - stamp_s) <= kSameTime_s)
            return nearest->second;
    }
    return std::vector<Detection>{};
}

std::string DetectionLine(double stamp_s, const std::string& class_name, const Detection& d) {
    return fmt::format("{:.6f} {} {:.3f} {:g} {:g} {:g} {:g}", stamp_s, class_name, d.probability,
                       d.box.x_min, d.box.y_min, d.box.x_max, d.box.y_max);
}

}  // namespace tessera
