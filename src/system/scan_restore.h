// What a saved scan gives back to a run: the map, and the state of loop closure.
#pragma once

#include <string>

#include "optimize/loop_closer.h"
#include "scan/scan_content.h"
#include "system/mapping_stage.h"

namespace tessera {

// Takes the map, and the labels' state if it has any, out of `scan`. The error names `path`.
Status RestoreMap(const std::string& path, ScanContent& scan, MappingStage& mapping);

// Takes keyframes and stored frames out of `scan`.
LoopCloser::Memory TakeLoopMemory(ScanContent& scan);

}  // namespace tessera
