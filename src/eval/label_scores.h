// Scores a run's labelled mesh against the class and instance images of a sequence with ground
// truth.
//
// Each vertex of the mesh is looked up in the ground-truth images that see it (projected with the
// true poses, measured depth within 2 cm). Its most frequent label is its ground truth. True
// classes that the run did not look for count as background, 0.
#pragma once

#include <Eigen/Geometry>
#include <map>
#include <string>
#include <vector>

#include "core/mesh.h"
#include "core/status.h"

namespace tessera {

// Scores of one class: [D18] Table 4, and vertex counts.
struct ClassScore {
    // Sums over the objects of the class (detection_scores.h, ObjectScore).
    std::int64_t visible = 0, detected = 0, correct = 0;
    double probability_sum = 0;
    std::int64_t vertices = 0, labelled = 0, both = 0;  // ground truth, run, both

    double Pt() const {
        return visible > 0 ? static_cast<double>(detected) / static_cast<double>(visible) : 0;
    }
    double Pc() const {
        return detected > 0 ? static_cast<double>(correct) / static_cast<double>(detected) : 0;
    }
    double Probability() const {
        return detected > 0 ? probability_sum / static_cast<double>(detected) : 0;
    }
    double Iou() const {
        const std::int64_t all = vertices + labelled - both;
        return all > 0 ? static_cast<double>(both) / static_cast<double>(all) : 0;
    }
};

// A true object of a wanted class that the mesh shows, and the run's object that overlaps it most.
struct InstanceScore {
    int truth = 0, found = 0;  // instance numbers; found 0 = none
    std::string class_name;
    bool right_class = false;
    // IoU of the axis-aligned bounding boxes of the two objects' vertices, in the ground truth's
    // world. The boxes ignore the outermost 0.5 % of vertices at each end of each axis.
    double box_iou = 0;
    double vertex_iou = 0;
    double centroid_error_m = 0;  // between the means of the two objects' vertices
};

struct LabelScores {
    std::int64_t vertices = 0;   // with ground truth
    double accuracy = 0;         // share with the right class, background included
    double object_accuracy = 0;  // the same, of vertices whose true class was looked for
    double mean_iou = 0;         // over the classes present in the ground truth
    std::map<std::string, ClassScore> classes;
    std::vector<InstanceScore> instances;
    int found_objects = 0;  // of the run
    // At 3D IoU of 0.25 and 0.5. The class must be right.
    double precision_25 = 0, recall_25 = 0, precision_50 = 0, recall_50 = 0;
    double centroid_error_mean_m = 0, centroid_error_max_m = 0;  // over the instances found
};

// `sequence` is a folder with rgb.txt, depth.txt, camera.yaml, groundtruth.txt, labels/, instances/
// and classes.txt, as `tessera synth` writes it. `run` is a run's folder with mesh.ply,
// objects.json, detections.txt, trajectory.txt. The trajectories align the two worlds. Errors name
// the file.
Result<LabelScores> EvaluateLabels(const std::string& sequence, const std::string& run);

std::string LabelScoresText(const LabelScores& scores);
std::string LabelScoresJson(const LabelScores& scores);

}  // namespace tessera
