// The true objects of images, and the detections in them.
#include <algorithm>

#include "eval/label_truth.h"

namespace tessera {
namespace {

constexpr double kSameTime_s = 0.002;
constexpr double kLeastPixels = 400.0 / (640 * 480);  // share of the image

using RowsByStamp = std::map<double, std::vector<DetectionRow>>;

RowsByStamp SortByStamp(const DetectionRows& rows) {
    RowsByStamp sorted;
    for (const double stamp_s : rows.frames) sorted[stamp_s];
    for (const DetectionRow& row : rows.rows) sorted[row.stamp_s].push_back(row);
    return sorted;
}

}  // namespace

void Rename(const ClassAliases& aliases, LabelTruth& truth) {
    for (auto& [id, name] : truth.class_names) name = Renamed(aliases, name);
}

std::vector<TrueObject> ObjectsOf(const LabelTruth& truth, const TruthImages& images) {
    struct Seen {
        int class_id = 0;
        std::size_t pixels = 0;
        DetectionBox box{1e9f, 1e9f, -1, -1};
    };
    std::map<int, Seen> seen;
    for (int y = 0; y < images.instance.height(); ++y)
        for (int x = 0; x < images.instance.width(); ++x) {
            if (images.instance(x, y) == 0) continue;
            Seen& s = seen[images.instance(x, y)];
            const auto u = static_cast<float>(x), v = static_cast<float>(y);
            s.class_id = images.class_id(x, y);
            ++s.pixels;
            s.box = {std::min(s.box.x_min, u), std::min(s.box.y_min, v), std::max(s.box.x_max, u),
                     std::max(s.box.y_max, v)};
        }
    const double least_pixels = kLeastPixels * static_cast<double>(images.instance.size());
    std::vector<TrueObject> objects;
    for (const auto& [instance, s] : seen)
        if (const auto name = truth.class_names.find(s.class_id); name != truth.class_names.end())
            objects.push_back(
                {instance, name->second, s.box, static_cast<double>(s.pixels) > least_pixels});
    return objects;
}

Result<std::vector<ScoredImage>> PairWithTruth(const LabelTruth& truth, const DetectionRows& rows,
                                               const std::string& path) {
    const RowsByStamp by_stamp = SortByStamp(rows);
    std::vector<ScoredImage> images;
    TruthImages files;
    for (std::size_t i = 0; i < truth.poses.size(); ++i) {
        const double stamp_s = truth.poses[i].stamp_s;
        const auto near = by_stamp.lower_bound(stamp_s - kSameTime_s);
        const bool found = near != by_stamp.end() && near->first <= stamp_s + kSameTime_s;
        if (!found && !rows.frames.empty()) continue;
        if (Status status = ReadTruthImages(truth, i, files); !status.ok()) return status;
        images.push_back({ObjectsOf(truth, files), {}});
        if (found) images.back().detections = near->second;
    }
    if (images.empty())
        return Status::Error(path + ": has no image of " + truth.folder + " by its time stamp");
    return images;
}

}  // namespace tessera
