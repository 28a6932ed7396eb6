// Opens the detector and the classes for the --labels argument.
#pragma once

#include "semantics/detector.h"
#include "synth/synthetic_source.h"

namespace tessera {

struct Labelling {
    std::unique_ptr<Detector> detector;
    LabelClasses classes;
};

// `name`: "synthetic" (ground truth of the source, with simulated errors), a network (.onnx, .cfg,
// .weights), or a detections file. `source`: the run's source. Errors are one line and name the
// file or the key.
Result<Labelling> OpenLabelling(const std::string& name, const std::string& source,
                                const SynthConfig& synthetic, const LabelConfig& config);

}  // namespace tessera
