// Detector for --labels synthetic: returns the ground truth of a built-in scene or model, with
// simulated errors at the configured rates.
#pragma once

#include "semantics/detector.h"
#include "synth/synthetic_source.h"

namespace tessera {

// `source`: the run's source, synthetic:NAME or synthetic:FILE.obj; others are an error. Detect
// uses the ground-truth pose of each frame.
Result<std::unique_ptr<Detector>> OpenSyntheticDetector(const std::string& source,
                                                        const SynthConfig& synthetic,
                                                        const LabelConfig& config);

}  // namespace tessera
