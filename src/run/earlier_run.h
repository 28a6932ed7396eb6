// A camera's run cannot be made again: its results are kept when the next run writes into the same
// folder.
#pragma once

#include <string>
#include <vector>

#include "core/status.h"

namespace tessera {

// Names of the results in `folder` that the next run into it writes anew, or leaves out.
std::vector<std::string> ResultsIn(const std::string& folder);

// Whether `folder` has the results of a run of a camera that tracked a frame.
bool HoldsCameraRun(const std::string& folder);

// If `folder` holds such a run, moves its results to
// folder/earlier_1, or the next number that is free, and returns that folder. Else returns "" and
// leaves all as it is. Errors name the file that cannot be moved.
Result<std::string> KeepEarlierRun(const std::string& folder);

}  // namespace tessera
