#include "semantics/detections_file.h"

#include <cmath>
#include <set>

#include "io/detections_text.h"

namespace tessera {
namespace {

constexpr double kSameTime_s = 0.002;

}  // namespace

Result<std::unique_ptr<DetectionsFile>> DetectionsFile::Read(const std::string& path) {
    Result<DetectionRows> read = ReadDetectionRows(path);
    if (!read.ok()) return read.status();
    if (read.value().rows.empty())
        return Status::Error(path +
                             ": contains no detections; expected lines 'stamp class probability "
                             "xmin ymin xmax ymax'");
    auto file = std::make_unique<DetectionsFile>();
    std::set<std::string> names;
    for (const DetectionRow& row : read.value().rows) {
        Detection detection;
        detection.name = row.name;
        detection.probability = row.probability;
        detection.box = row.box;
        names.insert(row.name);
        file->by_stamp_[row.stamp_s].push_back(std::move(detection));
    }
    file->names_.assign(names.begin(), names.end());
    return file;
}

Result<std::vector<Detection>> DetectionsFile::Detect(const Frame& frame) {
    // Rows have the recorded stamps.
    for (const double stamp_s : {frame.colour_stamp_s - frame.correction.colour_s,
                                 frame.stamp_s - frame.correction.depth_s}) {
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
