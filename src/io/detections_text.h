// Detections as text: lines "stamp class probability xmin ymin xmax ymax" with inclusive pixel
// bounds. "_" stands for a blank in a class name. '#' starts a comment; three comments mean
// something: "# frame STAMP" before the detections of an image that was looked at, "# classes
// NAME..." what was looked for, "# aliases NAME=NAME..." how names were changed.
#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "core/status.h"

namespace tessera {

// In pixels of an image, inclusive at both ends.
struct DetectionBox {
    float x_min = 0, y_min = 0, x_max = 0, y_max = 0;

    float Area() const;  // 0 if the box is empty
    bool operator==(const DetectionBox&) const = default;
};
// Intersection over union, [0, 1]. Thread-safe.
float BoxOverlap(const DetectionBox& a, const DetectionBox& b);

struct DetectionRow {
    double stamp_s = 0;
    std::string name;
    float probability = 0;  // [0, 1]
    DetectionBox box;       // at least one pixel
};

using ClassAliases = std::map<std::string, std::string>;  // another name -> our name

struct DetectionRows {
    std::vector<DetectionRow> rows;  // in the file's order
    std::vector<double> frames;      // stamps of "# frame"; empty if the file has none
    // Absent if the file does not say.
    std::optional<std::set<std::string>> classes;
    std::optional<ClassAliases> aliases;
};

// "tv=computer sofa=couch", separated by blanks. The error names the part that is wrong.
Result<ClassAliases> ParseAliases(const std::string& text);
// Returns our name for `name`, or `name` itself.
std::string Renamed(const ClassAliases& aliases, const std::string& name);

// Malformed lines and numbers out of range are errors: "FILE:LINE: ...".
Result<DetectionRows> ReadDetectionRows(const std::string& path);

}  // namespace tessera
