// A file without a name, for data that should not stay in memory. It disappears with the process.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "core/status.h"

namespace tessera {

// The folder for large temporary files: the environment variable TMPDIR, or /var/tmp.
std::string TemporaryFolder();

// Different ranges may be read and written by different threads.
class TemporaryFile {
  public:
    // Creates the file in the folder of `beside_path`. Errors name that path, and say what is wrong
    // and what to do.
    static Result<std::shared_ptr<TemporaryFile>> CreateBeside(const std::string& beside_path);
    ~TemporaryFile();
    TemporaryFile(const TemporaryFile&) = delete;
    TemporaryFile& operator=(const TemporaryFile&) = delete;

    // Errors do not name the file: "cannot be written: no space left on the device; ...".
    Status Write(std::span<const std::uint8_t> bytes, std::uint64_t offset);
    // It is an error if the file has fewer bytes.
    Status Read(std::span<std::uint8_t> bytes, std::uint64_t offset) const;
    // Gives the range back to the disk, where the file system can; it then reads as zeros.
    void Discard(std::uint64_t offset, std::uint64_t count);
    // Bytes that are free on its disk.
    std::uint64_t FreeOnDisk() const;

  private:
    explicit TemporaryFile(int file) : file_(file) {}

    const int file_;
};

}  // namespace tessera
