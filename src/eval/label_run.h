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

// Output of a run. Classes are compared by name; run and ground truth may use different class ids.
struct RunLabels {
    TriangleMesh mesh;  // in the ground truth's world
    std::map<int, std::string> class_names;
    std::vector<ScoredImage> images;  // those that the detector looked at
    std::set<std::string> wanted;     // classes that the run looked for
};

// Reads from a run's folder: mesh.ply (aligned to the ground truth by the two trajectories),
// objects.json, detections.txt. Gives the classes of the ground truth the run's names. Errors name
// the file.
Result<RunLabels> ReadLabelRun(const std::string& folder, LabelTruth& truth);

}  // namespace tessera
