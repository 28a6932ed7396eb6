// A build without the libraries that recordings need.
#include "recordings/endings.h"
#include "recordings/open_recording.h"

namespace tessera {

bool RecordingsAvailable() { return false; }

bool IsRecording(const std::string& path) {
    for (const char* ending : {".bag", ".mcap", ".db3", ".mkv", ".r3d", ".sens"})
        if (EndingOf(path) == ending) return true;
    return false;
}

Result<std::unique_ptr<FrameSource>> OpenRecording(const std::string& path,
                                                   const FolderSourceConfig&) {
    return Status::Error(path +
                         ": recordings of other programs are off: " + kRecordingsUnavailable);
}

}  // namespace tessera
