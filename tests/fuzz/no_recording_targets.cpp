// A build without recordings of other programs.
#include "fuzz/fuzz_target.h"

namespace tessera::fuzz {

std::vector<FuzzTarget> RecordingTargets() { return {}; }

}  // namespace tessera::fuzz
