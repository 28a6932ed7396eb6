// The cameras of an Azure Kinect, from the file calibration.json that its recordings contain. The
// file holds for the whole sensors; each mode delivers a part of them, perhaps at half the size.
// Source: github.com/microsoft/Azure-Kinect-Sensor-SDK. src/calibration/calibration.c reads the
// file; src/transformation has the modes (mode_specific_calibration.c), the lens
// (intrinsic_transformation.c) and the use of Rt (extrinsic_transformation.c).
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <string_view>

#include "core/camera.h"
#include "core/status.h"
#include "io/image_header.h"

namespace tessera {

struct K4aCamera {
    // In widths and heights of the sensor; (0, 0) is the sensor's top left corner. A colour sensor
    // has 4 : 3.
    double cx = 0.5, cy = 0.5, fx = 0.5, fy = 0.5;
    // (1 + k1 r^2 + k2 r^4 + k3 r^6) / (1 + k4 r^2 + k5 r^4 + k6 r^6)
    std::array<double, 6> k{};
    double p1 = 0, p2 = 0;
    double mixed = 2;  // of the tangential terms with x y; 1 in early devices
    Eigen::Vector2d distortion_centre = Eigen::Vector2d::Zero();
    Eigen::Isometry3d T_camera_device = Eigen::Isometry3d::Identity();  // "Rt"; metres

    // Where the lens shows the direction (x / z, y / z).
    Eigen::Vector2d Distort(const Eigen::Vector2d& ideal) const;
};

struct K4aCalibration {
    K4aCamera depth, colour;
};

// Errors say what is wrong. Never throws.
Result<K4aCalibration> ParseK4aCalibration(std::string_view json);

// Values of a usual device; another one differs by some pixels.
K4aCalibration UsualK4aCalibration();

struct K4aCameras {
    CameraCalibration depth, colour;
    Eigen::Isometry3d T_colour_depth = Eigen::Isometry3d::Identity();
    // The largest error of either lens, which the Brown-Conrady model only approximates, in its own
    // pixels. Of colour where the depth camera looks.
    double depth_error_px = 0, colour_error_px = 0;
};

// The cameras for images of these sizes. Without colour, `colour_size` is zero and the colour
// camera is the depth camera. An error if no mode has these sizes.
Result<K4aCameras> MakeK4aCameras(const K4aCalibration& calibration, ImageSize depth_size,
                                  ImageSize colour_size);

}  // namespace tessera
