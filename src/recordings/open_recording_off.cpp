// A build without the libraries that recordings need.
#include "recordings/endings.h"
#include "recordings/open_recording.h"

namespace tessera {

bool IsRecording(const std::string& path) {
    for (const char* ending : {".bag", ".mcap", ".db3", ".mkv", ".r3d", ".sens"})
        if (EndingOf(path) == ending) return true;
    return false;
}

Result<std::unique_ptr<FrameSource>> OpenRecording(const std::string& path,
                                                   const FolderSourceConfig&) {
    return Status::Error(path +
                         ": this program was built without recordings of other programs (install "
                         "libzip-dev, liblz4-dev, libbz2-dev, libzstd-dev and libsqlite3-dev, then "
                         "build again)");
}

}  // namespace tessera
