// .klg logs, as Logger2 writes them and Kintinuous and ElasticFusion read them: one file of depth
// in millimetres (raw or zlib) and colour (raw or JPEG). Little endian: int32 frames; then for each
// int64 stamp in microseconds, int32 bytes of depth, int32 bytes of colour, depth, colour.
#pragma once

#include <memory>
#include <string>

#include "core/status.h"
#include "io/folder_source.h"
#include "io/frame_source.h"

namespace tessera {

// The camera is that of camera.yaml beside the file; without one 640 x 480 pixels with a focal
// length of 528 are assumed, as those programs do, and noted. The source seeks; a frame that cannot
// be decoded is kSkip; a log that was cut off is read up to its last whole frame, with a note;
// frames whose stamp does not grow are left out, with a note. Errors name the file.
Result<std::unique_ptr<FrameSource>> OpenKlgSource(const std::string& path,
                                                   const FolderSourceConfig& config);

}  // namespace tessera
