// Joins the loop closure of two scans that see the same place: finds where the second lies in the
// first, and makes one pose graph of both.
#pragma once

#include <span>
#include <vector>

#include "optimize/loop_closer.h"
#include "optimize/scan_parts.h"

namespace tessera {

// Looks for keyframes of b in a. `a` is a's loop closure, resumed; `frames` are b's stored frames.
std::vector<CommonPlace> FindCommonPlaces(LoopCloser& a, std::span<const StoredFrame> frames,
                                          const FieldSettings& settings, double depth_units_per_m);

// Appends b, with its world moved into a's, and links both at the places. A part of b that no place
// joins goes beside the parts of a.
void AppendSession(LoopCloser::Memory b, const JointPose& pose, LoopCloser::Memory& a);

}  // namespace tessera
