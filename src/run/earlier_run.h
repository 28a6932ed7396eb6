// What is in the output folder before a run. A camera's run cannot be made again: its results are
// kept when the next run writes into the same folder.
#pragma once

#include <string>

#include "core/status.h"

namespace tessera {

// Call before anything is written: an error if `folder` is that of the recording `source`, or if a
// run into it would replace files that are not of a run. It need not exist.
Status CheckOutputFolder(const std::string& source, const std::string& folder);

// Whether `folder` has the results of a run of a camera that tracked a frame.
bool HoldsCameraRun(const std::string& folder);

// If `folder` holds such a run, moves its results to folder/earlier_1, or the next number that is
// free, and returns that folder. Else returns "" and leaves all as it is, also if the run wrote
// `resumed_scan` (as in run.json; empty: none), because the next one's results cover all of it.
// Errors name the file that cannot be moved.
Result<std::string> KeepEarlierRun(const std::string& folder, const std::string& resumed_scan);

// Removes the results of an earlier run, finished or killed, but for run.json: until that is
// written anew, it marks the folder as a run's.
void RemoveEarlierRun(const std::string& folder);

}  // namespace tessera
