// What a fuzzer needs of a reader: valid inputs to begin with, and a call that must survive any
// bytes. docs/reliability.md says how they are run.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "core/status.h"

namespace tessera::fuzz {

using Bytes = std::vector<std::uint8_t>;

struct FuzzTarget {
    std::string name;
    std::function<std::vector<Bytes>()> seeds;  // made by this project's own writers
    // Aborts on a broken promise: see CheckError.
    std::function<void(std::span<const std::uint8_t>)> run;
    int mutations = 5000;  // that the tests try
};

// All of them, in the order of docs/reliability.md.
std::vector<FuzzTarget> FuzzTargets();
std::vector<FuzzTarget> ImageTargets();
std::vector<FuzzTarget> ModelTargets();
std::vector<FuzzTarget> TextTargets();
std::vector<FuzzTarget> ScanTargets();
std::vector<FuzzTarget> StateTargets();
// None if the build has no recordings of other programs.
std::vector<FuzzTarget> RecordingTargets();

// The bytes as a regular file without a place on a disk.
class BytesAsFile {
  public:
    explicit BytesAsFile(std::span<const std::uint8_t> bytes);
    ~BytesAsFile();
    BytesAsFile(const BytesAsFile&) = delete;
    BytesAsFile& operator=(const BytesAsFile&) = delete;

    const std::string& path() const { return path_; }

  private:
    int file_;
    std::string path_;
};

// An error is one readable line that begins with the path: no more can be promised for all bytes.
void CheckError(const Status& status, const std::string& path);

Bytes BytesOf(const std::string& text);

}  // namespace tessera::fuzz
