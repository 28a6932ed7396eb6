// ORB features for place recognition, each with its 3D point from the depth image.
#pragma once

#include <Eigen/Core>
#include <array>
#include <bit>
#include <cstdint>
#include <vector>

#include "core/camera.h"
#include "mapping/prepared_frame.h"

namespace tessera {

// 256 bits; bit i is bit (i % 64) of word i / 64.
using Descriptor = std::array<std::uint64_t, 4>;

inline int HammingDistance(const Descriptor& a, const Descriptor& b) {
    int distance = 0;
    for (std::size_t i = 0; i < a.size(); ++i) distance += std::popcount(a[i] ^ b[i]);
    return distance;
}

// Two arrays of equal length.
struct Features {
    std::vector<Descriptor> descriptors;
    std::vector<Eigen::Vector3f> p_camera;  // metres

    std::size_t size() const { return descriptors.size(); }
};

// Returns at most `max_features`, spread over the image by OpenCV's ORB, without those that have no
// depth. Empty for a frame without colour. Does not depend on the number of threads.
Features ExtractFeatures(const PreparedFrame& frame, const PinholeCamera& camera, int max_features);

}  // namespace tessera
