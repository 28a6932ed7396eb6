// Object detectors for colour images: networks (dnn_detector.h), a file of precomputed detections
// (detections_file.h), or the ground truth of a synthetic scene (synthetic_detector.h).
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/frame.h"
#include "core/status.h"
#include "io/detections_text.h"
#include "semantics/label_config.h"

namespace tessera {

struct Detection {
    std::string name;       // the detector's name of the class
    int class_id = 0;       // index in LabelClasses; 0 until FilterWanted sets it
    float probability = 0;  // [0, 1]
    DetectionBox box;
    // Over the whole pixels of the box (PixelsOf), 1 = object. Empty if the detector gives no mask.
    Image<std::uint8_t> mask;
    // Describes what the object looks like, for open vocabularies: any length, the same for all
    // detections of a detector. Empty if the detector gives none.
    std::vector<float> embedding = {};
};

struct PixelBox {
    int x_begin = 0, y_begin = 0, x_end = 0, y_end = 0;  // exclusive ends
    int width() const { return x_end - x_begin; }
    int height() const { return y_end - y_begin; }
    bool empty() const { return width() <= 0 || height() <= 0; }
};
// Returns the whole pixels of a box that lie in the image. Accepts any values, including NaN.
PixelBox PixelsOf(const DetectionBox& box, int width, int height);

// Owner thread only.
class Detector {
  public:
    virtual ~Detector() = default;
    // Detects objects in the frame's colour image, of all classes and probabilities. After an error
    // (the network failed) the detector is no longer used. Never throws.
    virtual Result<std::vector<Detection>> Detect(const Frame& frame) = 0;
    // If true, Detect is not called for frames without colour.
    virtual bool needs_colour() const { return false; }
    // Makes the detector run only on the calling thread, as far as it can, because more urgent work
    // runs in parallel.
    virtual void WorkInBackground() {}
    // All class names that it can return; empty if they are not known beforehand.
    virtual const std::vector<std::string>& class_names() const = 0;
};

// Moves detections of labels.dynamic classes out of `detections`. Returns those with at least
// `min_probability`.
std::vector<Detection> ExtractDynamic(const LabelClasses& classes, double min_probability,
                                      std::vector<Detection>& detections);
// Keeps detections of wanted classes with at least `min_probability`, sets class_id and sorts by
// decreasing probability. Of two detections of a class under different names of the detector that
// overlap by more than `overlap` (BoxOverlap), the less probable one is removed. Under the same
// name only if they share nearly the same box: objects of a class lie on each other.
void FilterWanted(const LabelClasses& classes, double min_probability, double overlap,
                  std::vector<Detection>& detections);

}  // namespace tessera
