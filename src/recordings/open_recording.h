// Opens the recordings of other programs: ROS, RealSense, Azure Kinect, phones, ScanNet.
#pragma once

#include <memory>
#include <string>

#include "core/status.h"
#include "io/folder_source.h"
#include "io/frame_source.h"

namespace tessera {

// Whether this build reads recordings. If not, OpenRecording returns an error that includes
// kRecordingsUnavailable.
bool RecordingsAvailable();
inline constexpr const char* kRecordingsUnavailable =
    "install libzip-dev, liblz4-dev, libbz2-dev, libzstd-dev and libsqlite3-dev, and build again";

// Judged by a file's ending and by the files in a folder.
bool IsRecording(const std::string& path);

// `path` must be a recording. Errors name the file and what to do. The source can seek.
Result<std::unique_ptr<FrameSource>> OpenRecording(const std::string& path,
                                                   const FolderSourceConfig& config);

}  // namespace tessera
