// Files written whole or not at all, files read within bounds, and folders made ready for output.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "core/status.h"

namespace tessera {

// Writes beside `path`, syncs and renames; says what failed (no space left, not writable) and
// leaves no debris. A device or pipe is written in place, a symbolic link is followed. Thread-safe
// for different paths.
Status WriteTextFile(const std::string& path, const std::string& text);

// What an errno of writing means, and what to do: "no space left on the device; free some or choose
// another place".
std::string WriteErrorText(int error);

// Makes the folder (and its parents) and proves that it can be written to.
Status PrepareOutputFolder(const std::string& path);

// The file's bytes. A folder, an unreadable file or one of more than max_bytes is an error,
// whatever size the file claims to have.
Result<std::string> ReadWholeFile(const std::string& path, std::size_t max_bytes);

// What WriteTextFile does, in pieces: nothing is seen at `path` before Commit succeeded. Owner
// thread only.
class AtomicFile {
  public:
    explicit AtomicFile(const std::string& path);
    ~AtomicFile();  // without Commit: removes what was written
    AtomicFile(const AtomicFile&) = delete;
    AtomicFile& operator=(const AtomicFile&) = delete;

    // After an error nothing more is written; Commit reports the first error.
    void Write(std::string_view bytes);
    // Synced: a power cut after it does not lose the file. kLater leaves that to the system (some
    // seconds) and takes no time: for many files in a row.
    enum class Sync { kNow, kLater };
    Status Commit(Sync sync = Sync::kNow);

  private:
    void Fail(const char* what);
    void Close();

    std::string path_;       // as the user gave it, for messages
    std::string target_;     // behind symbolic links
    std::string temporary_;  // empty if written in place
    int file_ = -1;
    Status status_;
};

}  // namespace tessera
