// A scan as it is shown and exported. That of a run that was killed may hold parts that nothing
// joins with the rest, far away in the map (optimize/scan_parts.h).
#pragma once

#include "scan/scan_content.h"

namespace tessera {

// Removes the blocks that the scan does not show (ScanContent::Shows) from its map, if it has one.
void RemoveHiddenBlocks(ScanContent& scan);
// As ReadScan, without them.
Result<ScanContent> ReadScanToShow(const std::string& path, const ScanParts& parts);

}  // namespace tessera
