// What a run with labels wrote, as far as its scores need it.
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

// What the run wrote; truth's class numbers stand for names from here on.
struct RunLabels {
    TriangleMesh mesh;  // in the truth's world
    std::map<int, std::string> class_names;
    std::map<double, std::vector<RunDetection>> frames;  // that were looked at
    // Classes that were looked for, as far as one can tell.
    std::set<std::string> wanted;
};

// Of a run's folder: mesh.ply, laid over the truth by both trajectories, objects.json,
// detections.txt. Errors name the file.
Result<RunLabels> ReadLabelRun(const std::string& folder, const LabelTruth& truth);

}  // namespace tessera
