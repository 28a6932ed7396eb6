// The one way to open a file that comes from outside. Its content is not trusted.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/status.h"

namespace tessera {

// A regular file, open for reading. A folder, a pipe or a device is refused, never waited for.
// Every error names the file and says what is wrong. Different threads may read at the same time.
class InputFile {
  public:
    static Result<InputFile> Open(const std::string& path);
    ~InputFile();
    InputFile(InputFile&& other) noexcept;
    InputFile& operator=(InputFile&& other) noexcept;

    const std::string& path() const { return path_; }
    // When it was opened.
    std::uint64_t size() const { return size_; }
    // It is an error if the file ends before.
    Status ReadAt(std::uint64_t offset, std::span<std::uint8_t> bytes) const;

  private:
    InputFile(std::string path, int file) : path_(std::move(path)), file_(file) {}

    std::string path_;
    int file_ = -1;
    std::uint64_t size_ = 0;
};

// Reads the whole file. It is an error if it has more than max_bytes.
Result<std::string> ReadWholeFile(const std::string& path, std::size_t max_bytes);

// The same into existing storage. Thread-safe for distinct `bytes`.
Status ReadFileBytes(const std::string& path, std::size_t max_bytes,
                     std::vector<std::uint8_t>& bytes);

}  // namespace tessera
