#include "io/frame_source.h"

namespace tessera {

Status FrameSource::RecordTo(const std::string& path, bool) {
    return Status::Error(
        path +
        ": only openni2: cameras can record to .oni; give a folder name to record this source");
}

}  // namespace tessera
