// The places of the frames of a .klg log, found before any image is decoded.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/camera.h"
#include "core/input_file.h"

namespace tessera {

struct KlgEntry {
    std::int64_t stamp_us = 0;
    std::uint64_t offset = 0;  // of the depth data; colour follows
    std::uint32_t depth_bytes = 0, colour_bytes = 0;
};

struct KlgIndex {
    std::vector<KlgEntry> entries;  // strictly increasing stamps, at least one
    std::vector<std::string> warnings;
};

// Walks from header to header, up to the end of a log that was not closed (a count of 0). Allocates
// only for frames that are present, not for the number the file claims, and ends at a frame that is
// larger than the camera's frames can be. Of stamps that do not increase, as few as possible are
// dropped. It is an error if no frame is left.
Result<KlgIndex> ReadKlgIndex(const InputFile& file, const PinholeCamera& camera);

}  // namespace tessera
