// The output of a run with labels, as needed for scoring.
#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "core/mesh.h"
#include "core/status.h"
#include "eval/label_truth.h"

namespace tessera {

struct RunDetection {
    std::string name;
    double probability = 0;
    double x_min = 0, y_min = 0, x_max = 0, y_max = 0;
};

// Output of a run. Classes are compared by name; run and ground truth may use different class ids.
struct RunLabels {
    TriangleMesh mesh;  // in the ground truth's world
    std::map<int, std::string> class_names;
    std::map<double, std::vector<RunDetection>> frames;  // processed ones, by time stamp
    // Classes that the run looked for, as far as its output shows.
    std::set<std::string> wanted;
};

// Reads from a run's folder: mesh.ply (aligned to the ground truth by the two trajectories),
// objects.json, detections.txt. Errors name the file.
Result<RunLabels> ReadLabelRun(const std::string& folder, const LabelTruth& truth);

}  // namespace tessera
