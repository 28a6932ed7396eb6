// Label scores as text and as JSON.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "eval/label_scores.h"

namespace tessera {
namespace {

using Json = nlohmann::ordered_json;

}  // namespace

std::string LabelScoresText(const LabelScores& s) {
    std::string text = fmt::format("{:<16}{:>9}{:>8}{:>8}{:>7}{:>10}{:>7}\n", "class", "visible",
                                   "Pt %", "Pc %", "prob", "vertices", "IoU");
    for (const auto& [name, c] : s.classes)
        text += fmt::format("{:<16}{:>9}{:>8.1f}{:>8.1f}{:>7.2f}{:>10}{:>7.3f}\n", name, c.visible,
                            100 * c.Pt(), 100 * c.Pc(), c.Probability(), c.vertices, c.Iou());
    text += fmt::format(
        "vertices: {:.2f} % of {} correct, {:.2f} % of those on objects; mean IoU {:.3f}\n",
        100 * s.accuracy, s.vertices, 100 * s.object_accuracy, s.mean_iou);
    text += fmt::format(
        "instances: {} true, {} found; precision {:.2f}, recall {:.2f} at 3D IoU 0.25; {:.2f}, "
        "{:.2f} at 0.5; centroid error mean {:.3f} m, max {:.3f} m\n",
        s.instances.size(), s.found_objects, s.precision_25, s.recall_25, s.precision_50,
        s.recall_50, s.centroid_error_mean_m, s.centroid_error_max_m);
    return text;
}

std::string LabelScoresJson(const LabelScores& s) {
    Json classes = Json::object(), instances = Json::array();
    for (const auto& [name, c] : s.classes)
        classes[name] = {{"visible", c.visible},   {"pt", c.Pt()},
                         {"pc", c.Pc()},           {"probability", c.Probability()},
                         {"vertices", c.vertices}, {"iou", c.Iou()}};
    for (const InstanceScore& i : s.instances)
        instances.push_back({{"truth", i.truth},
                             {"class", i.class_name},
                             {"found", i.found},
                             {"right_class", i.right_class},
                             {"box_iou", i.box_iou},
                             {"vertex_iou", i.vertex_iou},
                             {"centroid_error_m", i.centroid_error_m}});
    const Json json = {{"vertices", s.vertices},
                       {"accuracy", s.accuracy},
                       {"object_accuracy", s.object_accuracy},
                       {"mean_iou", s.mean_iou},
                       {"found_objects", s.found_objects},
                       {"precision_25", s.precision_25},
                       {"recall_25", s.recall_25},
                       {"precision_50", s.precision_50},
                       {"recall_50", s.recall_50},
                       {"centroid_error_mean_m", s.centroid_error_mean_m},
                       {"centroid_error_max_m", s.centroid_error_max_m},
                       {"classes", classes},
                       {"instances", instances}};
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace tessera
