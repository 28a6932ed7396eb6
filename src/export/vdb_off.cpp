#include "export/vdb_writer.h"

namespace tessera {

bool VdbAvailable() { return false; }

Status WriteVdb(const std::string& path, const BlockMap&) {
    return Status::Error(path + ": .vdb is " + kVdbUnavailable);
}

}  // namespace tessera
