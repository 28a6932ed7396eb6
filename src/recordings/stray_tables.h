// The two tables of a Stray Scanner folder. Content is not trusted.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/camera.h"
#include "core/status.h"

namespace tessera {

// camera_matrix.csv: three rows of three numbers. The size is the video's, to which the matrix
// belongs. Errors name the file.
Result<PinholeCamera> ReadStrayCamera(const std::string& path, int width, int height);

struct StrayStamp {
    std::uint64_t frame = 0;
    double stamp_s = 0;
};

// odometry.csv, from its columns "timestamp" and "frame"; sorted by frame. Empty if the file cannot
// be read or its first line names no such columns. Damaged lines are left out.
std::vector<StrayStamp> ReadStrayStamps(const std::string& path);

}  // namespace tessera
