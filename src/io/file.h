// Atomic file writing and preparation of output folders. Files are read through
// core/input_file.h.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "core/status.h"

namespace tessera {

// Writes a temporary file next to `path`, syncs it and renames it. On error, reports what failed
// (no space left, not writable) and removes the temporary file. A device or pipe is written in
// place; a symbolic link is followed. Thread-safe for different paths.
Status WriteTextFile(const std::string& path, const std::string& text);

// Describes an errno from writing and what to do about it: "no space left on the device; free some
// space or choose another location".
std::string WriteErrorText(int error);

// Syncs the folder that holds `path`, so that a file made or renamed there survives a power cut.
// File systems that cannot do it are left alone.
void SyncFolderOf(const std::string& path);

// Creates the folder (and its parents) and checks that it is writable.
Status PrepareOutputFolder(const std::string& path);

// Like WriteTextFile, but in pieces, which may be small: nothing appears at `path` before Commit
// succeeds. Owner thread only.
class AtomicFile {
  public:
    explicit AtomicFile(const std::string& path);
    ~AtomicFile();  // without Commit: removes what was written
    AtomicFile(const AtomicFile&) = delete;
    AtomicFile& operator=(const AtomicFile&) = delete;

    // After an error, Write does nothing more. Commit reports the first error.
    void Write(std::string_view bytes);
    // kNow: the file survives a power cut after Commit. kLater: the system writes it to disk some
    // seconds later; takes no time, for many files in a row.
    enum class Sync { kNow, kLater };
    Status Commit(Sync sync = Sync::kNow);

  private:
    void WriteOut(std::string_view bytes);
    void Fail(const char* what);
    void Close();

    std::string path_;       // as the user gave it, for messages
    std::string target_;     // with symbolic links resolved
    std::string temporary_;  // empty if written in place
    std::string waiting_;    // small pieces that are not in the file yet
    int file_ = -1;
    Status status_;
};

}  // namespace tessera
