#include "eval/detection_run.h"

#include <filesystem>

#include "eval/label_truth.h"

namespace tessera {
Result<Detections> ReadDetections(const std::string& path, const ClassAliases& aliases) {
    const bool is_run = std::filesystem::is_directory(path);
    const std::string file = is_run ? path + "/detections.txt" : path;
    if (is_run && !std::filesystem::exists(file))
        return Status::Error(file + ": does not exist; was the run made with --labels?");
    Result<DetectionRows> rows = ReadDetectionRows(file);
    if (!rows.ok()) return rows.status();
    Detections detections;
    detections.rows = std::move(rows.value());
    detections.aliases = detections.rows.aliases.value_or(aliases);
    for (DetectionRow& row : detections.rows.rows) {
        row.name = Renamed(detections.aliases, row.name);
        if (!detections.rows.classes) detections.looked_for.insert(row.name);
    }
    if (detections.rows.classes)
        for (const std::string& name : *detections.rows.classes)
            detections.looked_for.insert(Renamed(detections.aliases, name));
    return detections;
}

Result<DetectionScores> EvaluateDetections(const std::string& sequence, const std::string& path,
                                           const ClassAliases& aliases, double min_probability) {
    Result<LabelTruth> truth = ReadLabelTruth(sequence);
    if (!truth.ok()) return truth.status();
    const Result<Detections> detections = ReadDetections(path, aliases);
    if (!detections.ok()) return detections.status();
    Rename(detections.value().aliases, truth.value());
    const Result<std::vector<ScoredImage>> images =
        PairWithTruth(truth.value(), detections.value().rows, path);
    if (!images.ok()) return images.status();
    return ScoreDetections(images.value(), detections.value().looked_for, min_probability);
}

}  // namespace tessera
