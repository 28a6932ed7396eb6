// Self-calibration of a whole scan (self_calibration.h), from the views of its keyframes.
#pragma once

#include "optimize/calibration_report.h"
#include "optimize/field_check.h"
#include "optimize/scan_graph.h"

namespace tessera {

// Compares consecutive keyframes, keyframes two apart, and loops. If the scan shows a calibration
// that differs, the graph and the settings get it; no frame may be added afterwards, as features
// and field checks belong to the one before. Error, and nothing is changed, if a keyframe's frame
// is missing or the solver fails.
Result<CalibrationReport> CalibrateScan(ScanGraph& graph, FrameStore& store,
                                        FieldSettings& settings);

}  // namespace tessera
