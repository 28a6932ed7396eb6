// A text file that grows line by line and is whole after every line, whatever happens next.
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

    // Makes the file, or empties the one that is there. Errors name it.
    Status Open(const std::string& path);
    bool is_open() const { return file_ >= 0; }
    // The text reaches the system whole, or the file is left as it was before. Errors name it.
    Status Append(std::string_view text);
    // Nothing appended is lost by a power cut after it.
    Status Sync();

  private:
    Status Failed() const;

    std::string path_;
    int file_ = -1;
    std::int64_t size_ = 0;  // bytes, all whole lines
};

}  // namespace tessera
