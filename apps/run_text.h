// Summarises a finished run in a few lines of text.
#pragma once

#include <string>

#include "eval/drift.h"
#include "run/run.h"

namespace tessera {

std::string RunText(const RunRequest& request, const RunSummary& summary);

// "ATE RMSE 0.0203 m (mean ..., median ..., max ...), 694 pairs, SE(3) alignment without scale over
// all frames, 100.0 % tracked". The protocol is always given with the figure.
std::string AteText(const AteResult& ate);
// A line for each distance, and one for all revisits.
std::string DriftText(const DriftResult& drift);

}  // namespace tessera
