#include "semantics/detector.h"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace tessera {
namespace {

// Networks have removed what overlaps less. In files of true boxes, books of a stack reach 0.67.
constexpr float kSameObject = 0.8f;

}  // namespace

PixelBox PixelsOf(const DetectionBox& box, int width, int height) {
    const auto whole = [](float value, int end) {
        return std::isfinite(value) ? static_cast<int>(std::lround(
                                          std::clamp(value, -1.0f, static_cast<float>(end))))
                                    : 0;
    };
    PixelBox pixels{std::max(0, whole(box.x_min, width)), std::max(0, whole(box.y_min, height)),
                    std::min(width, whole(box.x_max, width) + 1),
                    std::min(height, whole(box.y_max, height) + 1)};
    return pixels.empty() ? PixelBox{} : pixels;
}

std::vector<Detection> ExtractDynamic(const LabelClasses& classes, double min_probability,
                                      std::vector<Detection>& detections) {
    const auto rest =
        std::stable_partition(detections.begin(), detections.end(),
                              [&](const Detection& d) { return !classes.IsDynamic(d.name); });
    std::vector<Detection> dynamic(std::make_move_iterator(rest),
                                   std::make_move_iterator(detections.end()));
    detections.erase(rest, detections.end());
    std::erase_if(dynamic, [&](const Detection& d) {
        return !(d.probability >= static_cast<float>(min_probability));
    });
    return dynamic;
}

void FilterWanted(const LabelClasses& classes, double min_probability, double overlap,
                  std::vector<Detection>& detections) {
    for (Detection& detection : detections) detection.class_id = classes.IdOf(detection.name);
    std::erase_if(detections, [&](const Detection& d) {
        return d.class_id == 0 || !(d.probability >= static_cast<float>(min_probability));
    });
    std::ranges::stable_sort(detections, std::greater{}, &Detection::probability);
    const auto most = static_cast<float>(overlap), most_of_a_name = std::max(most, kSameObject);
    std::vector<Detection> kept;
    for (Detection& d : detections)
        if (std::ranges::none_of(kept, [&](const Detection& k) {
                return k.class_id == d.class_id &&
                       BoxOverlap(k.box, d.box) > (k.name == d.name ? most_of_a_name : most);
            }))
            kept.push_back(std::move(d));
    detections = std::move(kept);
}

}  // namespace tessera
