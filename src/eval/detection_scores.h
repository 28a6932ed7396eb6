// Scores of a detector against the true boxes of images: precision, recall and average precision by
// class, and [D18] Table 4 by object.
#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "io/detections_text.h"

namespace tessera {

struct TrueObject {
    int instance = 0;
    std::string class_name;
    DetectionBox box;  // of its visible pixels
    // False: shows too few pixels to be asked for. Detecting it is neither right nor wrong.
    bool counts = true;
};

struct ScoredImage {
    std::vector<TrueObject> objects;  // of all classes
    std::vector<DetectionRow> detections;
};

// Of one class, or of all together.
struct DetectionScore {
    std::int64_t visible = 0;         // objects that count, in all images
    std::int64_t detections = 0;      // with at least the least probability
    std::int64_t true_positives = 0;  // of these
    double probability_sum = 0;       // over `detections`
    // Area under the precision envelope over recall, of detections of any probability; 0 without
    // visible objects.
    double average_precision = 0;

    double Precision() const;
    double Recall() const;
    double Probability() const;
};

// One object in all images: [D18] Table 4.
struct ObjectScore {
    std::string class_name;
    std::int64_t visible = 0;    // images in which it counts
    std::int64_t detected = 0;   // of those, matched by a detection of any class
    std::int64_t right = 0;      // of those, by one of its class
    double probability_sum = 0;  // over `detected`

    double Pt() const;
    double Pc() const;
    double Probability() const;
};

struct DetectionScores {
    std::int64_t images = 0;
    double min_probability = 0;
    double least_in_file = 1;  // the lowest probability of all detections
    DetectionScore all;  // its average_precision: the mean of the classes with visible objects
    // Classes that were looked for and that are visible or were detected.
    std::map<std::string, DetectionScore> classes;
    std::map<int, ObjectScore> objects;  // by instance; of classes that were looked for
    // Visible classes that were not looked for: how often an object of them is visible.
    std::map<std::string, std::int64_t> not_looked_for;
};

// Boxes match if their intersection over union is at least 0.5. Detections take objects in the
// order of their probability, each the one it overlaps most among those left: by class for the
// class scores, all together in an image for the object scores. All but `average_precision` count
// detections with at least `min_probability`. Detections of classes that are not in `looked_for`
// are ignored. Thread-safe.
DetectionScores ScoreDetections(const std::vector<ScoredImage>& images,
                                const std::set<std::string>& looked_for, double min_probability);

std::string DetectionScoresText(const DetectionScores& scores);
std::string DetectionScoresJson(const DetectionScores& scores);

}  // namespace tessera
