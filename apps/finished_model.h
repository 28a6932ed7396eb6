// The files of a finished model.
#pragma once

#include <string>

#include "finish/finish.h"

namespace tessera {

// Writes model.glb, model_lod1.glb ..., model.obj, filled.ply, finish.json and preview.png into the
// folder `out`, which must exist. `level`: the model's z axis is up (glTF wants y up).
Status WriteFinishedModel(const std::string& out, const FinishedModel& finished, bool level);

}  // namespace tessera
