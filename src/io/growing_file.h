// A text file that grows line by line and is complete after every line, even if the process dies.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "core/status.h"

namespace tessera {

// Owner thread only.
class GrowingFile {
  public:
    GrowingFile() = default;
    ~GrowingFile();
    GrowingFile(const GrowingFile&) = delete;
    GrowingFile& operator=(const GrowingFile&) = delete;

    // Creates the file, or truncates an existing one. Errors name the file.
    Status Open(const std::string& path);
    bool is_open() const { return file_ >= 0; }
    // Hands the whole text to the system, or leaves the file as it was before. Errors name the
    // file.
    Status Append(std::string_view text);
    // After this, a power cut loses nothing that was appended.
    Status Sync();

  private:
    Status Failed() const;

    std::string path_;
    int file_ = -1;
    std::int64_t size_ = 0;  // bytes, complete lines only
};

}  // namespace tessera
