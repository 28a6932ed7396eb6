// The detections of a run or of a file, scored against the true classes and instances of a
// sequence.
#pragma once

#include <set>
#include <string>

#include "core/status.h"
#include "eval/detection_scores.h"

namespace tessera {

struct Detections {
    DetectionRows rows;  // renamed by `aliases`
    ClassAliases aliases;
    // The file's "# classes", renamed; without that line, the classes that it contains.
    std::set<std::string> looked_for;
};

// `path`: a file (io/detections_text.h) or a run's folder, whose detections.txt is read.
// `aliases`: for a file without a line "# aliases". Errors name the file.
Result<Detections> ReadDetections(const std::string& path, const ClassAliases& aliases);

// `sequence`: a folder as `tessera synth` writes it (label_scores.h). The other arguments: see
// ReadDetections and ScoreDetections. Errors name the file.
Result<DetectionScores> EvaluateDetections(const std::string& sequence, const std::string& path,
                                           const ClassAliases& aliases, double min_probability);

}  // namespace tessera
