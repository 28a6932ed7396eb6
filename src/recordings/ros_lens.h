// The lens models of ROS messages and RealSense's bags, as the one that core/camera.h has.
#pragma once

#include <string>

#include "core/camera.h"
#include "recordings/ros_message.h"

namespace tessera {

struct RosLens {
    LensDistortion lens;
    std::string warning;  // if the lens is only approximated badly, or its model is not known
};

// "plumb_bob", "rational_polynomial" and "equidistant" (sensor_msgs/distortion_models.h), "Brown
// Conrady", "Modified Brown Conrady" and "Inverse Brown Conrady" (librealsense, rs2_distortion).
// Others than plumb_bob are fitted over the whole image. Thread-safe.
RosLens RosLensOf(const RosCameraInfo& info);

}  // namespace tessera
