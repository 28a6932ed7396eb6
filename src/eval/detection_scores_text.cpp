// Detection scores as text and as JSON.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "eval/detection_scores.h"

namespace tessera {
namespace {

using ScoresJson = nlohmann::ordered_json;

std::string RowText(const std::string& name, const DetectionScore& s) {
    return fmt::format("{:<16}{:>9}{:>12}{:>9}{:>11.3f}{:>8.3f}{:>7.3f}{:>7.2f}\n", name, s.visible,
                       s.detections, s.true_positives, s.Precision(), s.Recall(),
                       s.average_precision, s.Probability());
}

ScoresJson RowJson(const DetectionScore& s) {
    return {{"visible", s.visible},
            {"detections", s.detections},
            {"true_positives", s.true_positives},
            {"precision", s.Precision()},
            {"recall", s.Recall()},
            {"ap50", s.average_precision},
            {"probability", s.Probability()}};
}

}  // namespace

std::string DetectionScoresText(const DetectionScores& s) {
    std::string text =
        fmt::format("{:<16}{:>9}{:>12}{:>9}{:>11}{:>8}{:>7}{:>7}\n", "class", "visible",
                    "detections", "correct", "precision", "recall", "AP50", "prob");
    for (const auto& [name, score] : s.classes)
        if (score.visible > 0 || score.detections > 0) text += RowText(name, score);
    text += RowText("all", s.all);
    text += fmt::format("\n{:<9}{:<16}{:>9}{:>8}{:>8}{:>7}\n", "object", "class", "visible", "Pt %",
                        "Pc %", "prob");
    for (const auto& [instance, o] : s.objects)
        text += fmt::format("{:<9}{:<16}{:>9}{:>8.1f}{:>8.1f}{:>7.2f}\n", instance, o.class_name,
                            o.visible, 100 * o.Pt(), 100 * o.Pc(), o.Probability());
    text += fmt::format(
        "\n{} images; box IoU 0.5; detections of probability {:g} and more, for AP50 {:g} and "
        "more\n",
        s.images, s.min_probability, s.least_in_file);
    if (s.not_looked_for.empty()) return text;
    text += "not looked for, but visible:";
    for (const auto& [name, count] : s.not_looked_for) text += fmt::format(" {} ({})", name, count);
    return text + "\n";
}

std::string DetectionScoresJson(const DetectionScores& s) {
    ScoresJson classes = ScoresJson::object(), objects = ScoresJson::array();
    for (const auto& [name, score] : s.classes) classes[name] = RowJson(score);
    for (const auto& [instance, o] : s.objects)
        objects.push_back({{"instance", instance},
                           {"class", o.class_name},
                           {"visible", o.visible},
                           {"detected", o.detected},
                           {"right", o.right},
                           {"pt", o.Pt()},
                           {"pc", o.Pc()},
                           {"probability", o.Probability()}});
    const ScoresJson json = {{"images", s.images},
                             {"min_probability", s.min_probability},
                             {"least_in_file", s.least_in_file},
                             {"all", RowJson(s.all)},
                             {"classes", classes},
                             {"objects", objects},
                             {"not_looked_for", s.not_looked_for}};
    return json.dump(2, ' ', false, ScoresJson::error_handler_t::replace) + "\n";
}

}  // namespace tessera
