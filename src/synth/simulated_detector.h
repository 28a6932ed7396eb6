// What a detector would say of a scene's view, made from the truth with mistakes at known rates:
// for sequences written to disk and for runs on built-in scenes. Pure functions of their arguments,
// thread-safe.
#pragma once

#include <cstdint>
#include <vector>

#include "core/camera.h"
#include "core/image.h"
#include "synth/scene.h"

namespace tessera {

// The pixels of one instance; inclusive.
struct InstanceBox {
    int x_min, y_min, x_max, y_max;
    std::int64_t pixels;
};
// One an instance of the scene, in their order; those not in view have no pixels.
std::vector<InstanceBox> FindInstanceBoxes(const Image<std::uint16_t>& instance,
                                           std::size_t instance_count);

// Which instance each pixel's centre shows; 0 where that is the surroundings or nothing. Uses all
// cores (TBB).
Image<std::uint16_t> CastInstances(const Scene& scene, const PinholeCamera& camera,
                                   const Eigen::Isometry3d& T_world_camera, double time_s);

struct DetectorMistakes {
    double missed = 0.10, wrong_class = 0.03;  // shares
};

struct SimulatedDetection {
    int instance = 0;
    int class_id = 0;  // perhaps a wrong one
    double probability = 0;
    InstanceBox box{};
};
// Of instances with more than 400 pixels of a 640x480 image, in proportion for others; p = 0.9 +-
// 0.06.
std::vector<SimulatedDetection> SimulateDetections(const Scene& scene,
                                                   const std::vector<InstanceBox>& boxes,
                                                   std::size_t image_pixels, std::uint64_t seed,
                                                   std::int64_t frame,
                                                   const DetectorMistakes& mistakes = {});

}  // namespace tessera
