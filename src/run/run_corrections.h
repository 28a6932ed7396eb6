// What a run found about its camera, for reading its frames again as it saw them.
#pragma once

#include <string>

#include "system/run_config.h"

namespace tessera {

// Sets the intrinsics that a run used, and the registration and vignetting that it corrected, from
// the text of its run.json. Leaves out what is missing or no number.
void UseCorrections(const std::string& run_json, RunConfig& config);

}  // namespace tessera
