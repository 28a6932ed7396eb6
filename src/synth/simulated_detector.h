// Simulates an object detector from ground truth, with errors at given rates: for sequences written
// to disk and for runs on built-in scenes. Pure functions, thread-safe.
#pragma once

#include <cstdint>
#include <vector>

#include "core/camera.h"
#include "core/image.h"
#include "synth/scene.h"

namespace tessera {

// Pixel bounds of one instance, inclusive.
struct InstanceBox {
    int x_min, y_min, x_max, y_max;
    std::int64_t pixels;
};
// Returns one box per instance of the scene, in order. Instances out of view have 0 pixels.
std::vector<InstanceBox> FindInstanceBoxes(const Image<std::uint16_t>& instance,
                                           std::size_t instance_count);

// Returns the instance at each pixel centre; 0 for surroundings or no surface. Uses all cores
// (TBB).
Image<std::uint16_t> CastInstances(const Scene& scene, const PinholeCamera& camera,
                                   const Eigen::Isometry3d& T_world_camera, double time_s);

struct DetectorMistakes {
    double missed = 0.10, wrong_class = 0.03;  // rates
};

struct SimulatedDetection {
    int instance = 0;
    int class_id = 0;  // may be wrong
    double probability = 0;
    InstanceBox box{};
};
// Detects instances with more than 400 pixels at 640x480, scaled for other sizes. p = 0.9 +- 0.06.
std::vector<SimulatedDetection> SimulateDetections(const Scene& scene,
                                                   const std::vector<InstanceBox>& boxes,
                                                   std::size_t image_pixels, std::uint64_t seed,
                                                   std::int64_t frame,
                                                   const DetectorMistakes& mistakes = {});

}  // namespace tessera
