// .klg logs, as written by Logger2 and read by Kintinuous and ElasticFusion: one file with depth in
// millimetres (raw or zlib) and colour (raw or JPEG). Little endian. An int32 number of frames;
// then for each frame: int64 stamp in microseconds, int32 depth size in bytes, int32 colour size in
// bytes, depth, colour.
#pragma once

#include <memory>
#include <string>

#include "core/status.h"
#include "io/folder_source.h"
#include "io/frame_source.h"

namespace tessera {

// Takes the camera from camera.yaml next to the file. Without it, assumes 640 x 480 pixels and a
// focal length of 528, as those programs do, and adds a note. The source can seek. A frame that
// cannot be decoded returns kSkip. A truncated log is read up to its last complete frame, with a
// note. Frames whose stamps do not increase are dropped, with a note. Errors name the file.
Result<std::unique_ptr<FrameSource>> OpenKlgSource(const std::string& path,
                                                   const FolderSourceConfig& config);

}  // namespace tessera
