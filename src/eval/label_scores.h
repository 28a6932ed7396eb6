// How well a run labelled: its labelled mesh against the class and instance images of a sequence
// with truth.
//
// Each vertex of the mesh is looked up in the truth images that see it (projected with the true
// poses, measured depth within 2 cm); the majority is its truth. Classes of the truth that the run
// did not look for count as background, 0.
#pragma once

#include <Eigen/Geometry>
#include <map>
#include <string>
#include <vector>

#include "core/mesh.h"
#include "core/status.h"

namespace tessera {

// [D18] Table 4 and the vertices of one class.
struct ClassScore {
    std::int64_t visible = 0;  // instances in frames looked at (over 400 pixels of 640x480)
    // Of those, with a detection of any class on it (boxes overlap by half).
    std::int64_t detected = 0;
    std::int64_t correct = 0;                           // of those, of the right class
    double probability_sum = 0;                         // of the detected
    std::int64_t vertices = 0, labelled = 0, both = 0;  // truth, run, in common

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

// A true object of a class that was looked for and that the mesh shows, and the run's that fits it
// best.
struct InstanceScore {
    int truth = 0, found = 0;  // numbers; found 0 = none
    std::string class_name;
    bool right_class = false;
    // Of the axis-aligned boxes of both's vertices, in the truth's world.
    double box_iou = 0;
    double vertex_iou = 0;
    double centroid_error_m = 0;  // of both's vertices' means
};

struct LabelScores {
    std::int64_t vertices = 0;   // with a truth
    double accuracy = 0;         // share of them with the right class, background included
    double object_accuracy = 0;  // of those whose truth is a class looked for
    double mean_iou = 0;         // of the classes that the truth has
    std::map<std::string, ClassScore> classes;
    std::vector<InstanceScore> instances;
    int found_objects = 0;  // the run's
    // At 3D IoU 0.25 and 0.5, right class needed.
    double precision_25 = 0, recall_25 = 0, precision_50 = 0, recall_50 = 0;
    double centroid_error_mean_m = 0, centroid_error_max_m = 0;  // of the instances found
};

// `sequence`: a folder with rgb.txt, depth.txt, camera.yaml, groundtruth.txt, labels/, instances/
// and classes.txt, as `tessera synth` writes it. `run`: a run's folder with mesh.ply, objects.json,
// detections.txt, trajectory.txt; the worlds are laid over each other by the trajectories. Errors
// name the file.
Result<LabelScores> EvaluateLabels(const std::string& sequence, const std::string& run);

std::string LabelScoresText(const LabelScores& scores);
std::string LabelScoresJson(const LabelScores& scores);

}  // namespace tessera
