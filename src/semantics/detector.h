// Who finds objects in colour images: networks (dnn_detector.h), a file of detections made
// beforehand (detections_file.h), or the truth of a built-in scene (synthetic_detector.h).
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/frame.h"
#include "core/status.h"
#include "semantics/label_config.h"

namespace tessera {

// Pixels, inclusive at both ends, of the frame's images.
struct DetectionBox {
    float x_min = 0, y_min = 0, x_max = 0, y_max = 0;

    float Area() const;  // 0 if it holds no pixel
    bool operator==(const DetectionBox&) const = default;
};
// Intersection over union, [0, 1].
float BoxOverlap(const DetectionBox& a, const DetectionBox& b);

struct Detection {
    std::string name;       // as the detector calls the class
    int class_id = 0;       // LabelClasses; 0 until KeepWanted set it
    float probability = 0;  // [0, 1]
    DetectionBox box;
    // Of the box's whole pixels (PixelsOf): 1 = the object; empty if there is none.
    Image<std::uint8_t> mask;
};

struct PixelBox {
    int x_begin = 0, y_begin = 0, x_end = 0, y_end = 0;  // the ends are excluded
    int width() const { return x_end - x_begin; }
    int height() const { return y_end - y_begin; }
    bool empty() const { return width() <= 0 || height() <= 0; }
};
// The whole pixels of a box that lie in an image. Any numbers, also none at all, are taken.
PixelBox PixelsOf(const DetectionBox& box, int width, int height);

// Owner thread only.
class Detector {
  public:
    virtual ~Detector() = default;
    // What there is in the frame's colour image, of all classes and probabilities. An error ends
    // its use: the network broke, or the frame has no colour. Never throws.
    virtual Result<std::vector<Detection>> Detect(const Frame& frame) = 0;
    // From now on it works beside something more urgent: on the calling thread only, as far as it
    // can choose.
    virtual void WorkInBackground() {}
    // All that it may say; empty if that is not known beforehand.
    virtual const std::vector<std::string>& class_names() const = 0;
};

// Takes those of labels.dynamic out of `detections`, and returns the ones with enough probability.
std::vector<Detection> TakeDynamic(const LabelClasses& classes, double min_probability,
                                   std::vector<Detection>& detections);
// Those of wanted classes and enough probability, with class_id set; by falling probability.
void KeepWanted(const LabelClasses& classes, double min_probability,
                std::vector<Detection>& detections);

}  // namespace tessera
