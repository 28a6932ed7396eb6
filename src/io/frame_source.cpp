#include "io/frame_source.h"

namespace tessera {

Status FrameSource::RecordTo(const std::string& path, bool) {
    return Status::Error(
        path +
        ": only openni2: cameras record to .oni; give a folder's name to record this source");
}

}  // namespace tessera
