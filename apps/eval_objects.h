// The evaluations against a sequence with a true class and instance per pixel.
#pragma once

#include "command.h"

namespace tessera {

// Adds labels and detections to `tessera eval`.
void AddObjectEvaluations(CLI::App& eval, CommandContext& context);

}  // namespace tessera
