// From what a person gives as --labels to a detector and the classes to look for.
#pragma once

#include "semantics/detector.h"
#include "synth/synthetic_source.h"

namespace tessera {

struct Labelling {
    std::unique_ptr<Detector> detector;
    LabelClasses classes;
};

// `name`: "synthetic" (the truth of the source, with mistakes), a network (.onnx, .cfg, .weights),
// or else a detections file. `source`: the run's. The error is one line that names the file or key.
Result<Labelling> OpenLabelling(const std::string& name, const std::string& source,
                                const SynthConfig& synthetic, const LabelConfig& config);

}  // namespace tessera
