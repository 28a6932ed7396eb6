// The files of a finished model.
#pragma once

#include <string>

#include "finish/finish.h"

namespace tessera {

inline constexpr int kMostLowerLevels = 6;  // that --levels takes

// Writes model.glb, model_lod1.glb ..., model.obj, filled.ply, finish.json and preview.png into the
// folder `out`, which must exist. Then removes the lower levels and the watertight.obj that another
// model left there. `level`: the model's z axis is up (glTF wants y up).
Status WriteFinishedModel(const std::string& out, const FinishedModel& finished, bool level);

}  // namespace tessera
