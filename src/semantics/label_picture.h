// What a detector finds in a frame, beside what the map shows there: tells why an object is
// labelled or not.
#pragma once

#include <span>

#include "core/mesh.h"
#include "semantics/label_image.h"

namespace tessera {

// Images of one size. They are only read.
struct LabelViews {
    const ColourImage& colour;              // the frame's; may be empty
    std::span<const Detection> detections;  // as returned by FilterWanted
    const LabelImage& objects;              // of these detections
    const ColourImage& predicted_colour;    // the map, seen from the frame's pose
    const Image<VertexLabel>& predicted;    // LabelMapper::PredictLabels from there
};

// Two rows of two images with titles. First row: the frame with the detections' boxes, classes and
// probabilities; the object image made of them ([D18] figure 7), grey where a pixel in a box votes
// for the background, black where it does not vote. Second row: the predicted colour and the
// predicted object image (figure 8) with the objects' numbers. Thread-safe.
ColourImage LabelPicture(const LabelViews& views, const LabelClasses& classes);

}  // namespace tessera
