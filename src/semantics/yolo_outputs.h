// Decodes the outputs of detection networks. The shapes of the outputs identify the network family.
// Plain arrays, no library types. Pure functions, thread-safe.
//
// S is the edge of the square input in pixels, A = (S/8)^2 + (S/16)^2 + (S/32)^2 the cells of the
// three strides, C the number of classes.
//   YOLOX    1 x A x (5 + C)    centre and size in cells of their stride, sizes as logarithms
//   YOLOv5   1 x 3A x (5 + C)   centre and size in input pixels
//   YOLOv8   1 x (4 + C) x A    the same, channels first; with masks 1 x (4 + C + 32) x A and a
//                               second output 1 x 32 x S/4 x S/4
//   Darknet  several N x (5 + C), relative to the input's size
#pragma once

#include <string>
#include <vector>

#include "core/status.h"
#include "semantics/detector.h"

namespace tessera {

struct OutputArray {
    std::vector<int> shape;
    const float* data = nullptr;  // row-major
};

struct YoloLayout {
    ModelFamily family = ModelFamily::kAuto;  // never kAuto once recognised
    int input_px = 0;
    int classes = 0;
    int mask_coefficients = 0;                // 0: no masks
    int boxes_output = 0, masks_output = -1;  // indices
};

// A `family` other than kAuto restricts the search to that one. The error lists the shapes.
Result<YoloLayout> RecogniseOutputs(const std::vector<OutputArray>& outputs, int input_px,
                                    ModelFamily family);

// One box in input pixels. Bounds are continuous coordinates, not inclusive pixels.
struct RawDetection {
    int class_index = 0;
    float probability = 0;
    float x_min = 0, y_min = 0, x_max = 0, y_max = 0;
    std::vector<float> mask_coefficients;
};

// Returns the boxes with at least `min_probability` > 0, in the order of the outputs. Skips boxes
// that are not finite.
std::vector<RawDetection> DecodeOutputs(const YoloLayout& layout,
                                        const std::vector<OutputArray>& outputs,
                                        float min_probability);

// If two boxes of one class overlap by more than `overlap`, keeps only the more probable one. Sorts
// by decreasing probability.
void SuppressOverlaps(float overlap, std::vector<RawDetection>& detections);

// The object's mask, 1 inside, over the pixels `pixels` of a frame that the network saw with
// `scale_x` and `scale_y` input pixels per frame pixel: sigmoid(coefficients * prototypes) > 0.5,
// the product interpolated linearly between the prototypes' cells of 4 x 4 input pixels. Only for
// layouts with masks.
Image<std::uint8_t> MaskOf(const YoloLayout& layout, const std::vector<OutputArray>& outputs,
                           const RawDetection& detection, const PixelBox& pixels, double scale_x,
                           double scale_y);

}  // namespace tessera
