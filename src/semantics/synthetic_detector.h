// The truth of a built-in scene or model as a detector's words, with mistakes at the configured
// rates: --labels synthetic.
#pragma once

#include "semantics/detector.h"
#include "synth/synthetic_source.h"

namespace tessera {

// `source`: the run's own, synthetic:NAME or synthetic:FILE.obj; others are an error. Its frames
// carry their true pose, by which they are detected.
Result<std::unique_ptr<Detector>> OpenSyntheticDetector(const std::string& source,
                                                        const SynthConfig& synthetic,
                                                        const LabelConfig& config);

}  // namespace tessera
