// The camera model. Everything downstream of a source sees an ideal pinhole camera. Sources correct
// the lens distortion given in the calibration file before they hand out an image.
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <string>

#include "core/status.h"

namespace tessera {

// Right-handed camera frame: x right, y down, z forward. Pixel (0, 0) is the top-left pixel's
// centre.
struct PinholeCamera {
    int width = 640;                                        // pixels
    int height = 480;                                       // pixels
    double fx = 525.0, fy = 525.0, cx = 319.5, cy = 239.5;  // pixels

    // [B14] eq. 2. p_camera.z() must not be 0.
    Eigen::Vector2d Project(const Eigen::Vector3d& p_camera) const {
        return {p_camera.x() / p_camera.z() * fx + cx, p_camera.y() / p_camera.z() * fy + cy};
    }
    // [B14] eq. 1. Returns the point in the camera frame, in metres, of pixel (u, v) at depth z
    // metres.
    Eigen::Vector3d Unproject(double u, double v, double z) const {
        return {(u - cx) / fx * z, (v - cy) / fy * z, z};
    }
    // Subsampled camera: keeps every step-th pixel in both directions. Its pixel (k, l) is pixel (k
    // step + step / 2, l step + step / 2) of this camera, in integer arithmetic.
    PinholeCamera Every(int step) const {
        const int first = step / 2;
        return {width / step, height / step,       fx / step,
                fy / step,    (cx - first) / step, (cy - first) / step};
    }
    bool operator==(const PinholeCamera&) const = default;
};

// Rejects values that no depth camera has: "fx: 0 is not plausible".
Status CheckPlausible(const PinholeCamera& camera);

// Brown-Conrady coefficients in OpenCV's order; all zero means an ideal lens.
struct LensDistortion {
    double k1 = 0, k2 = 0, p1 = 0, p2 = 0, k3 = 0;
    bool IsZero() const { return k1 == 0 && k2 == 0 && p1 == 0 && p2 == 0 && k3 == 0; }
    bool operator==(const LensDistortion&) const = default;
};

// A colour camera beside the depth camera, whose images are not registered to depth.
struct ColourCamera {
    PinholeCamera pinhole;  // its image size may differ from the depth camera's
    LensDistortion distortion;
    // From the depth camera's frame to the colour camera's.
    Eigen::Isometry3d T_colour_depth = Eigen::Isometry3d::Identity();
};

// Contents of a camera.yaml file.
struct CameraCalibration {
    PinholeCamera pinhole;
    LensDistortion distortion;
    double depth_scale = 5000.0;    // stored depth value / depth_scale = metres
    double fps = 30.0;              // frames per second, for sources without time stamps
    bool depth_scale_given = true;  // false: depth_scale is the default
    // Share of the brightness that colour images lose in their corners; it grows with the square of
    // the distance from the image's centre. Negative: the corners are too bright.
    double vignetting = 0;
    std::optional<ColourCamera> colour = std::nullopt;  // nullopt: registered to depth
};

// Reads width, height, fx, fy, cx, cy, distortion (4 or 5 numbers), depth_scale, fps,
// vignetting, and colour (docs/conventions.md). The sign of a negative fy (ICL-NUIM) is dropped.
// Unknown or repeated keys, missing intrinsics and implausible values are errors that name the
// file, the key and the value.
Result<CameraCalibration> ReadCameraFile(const std::string& path);

// The same from text; errors name it so.
Result<CameraCalibration> ParseCameraText(const std::string& text, const std::string& name);

// Returns the text of a camera.yaml file. Every value round-trips exactly, but the rotation of a
// colour camera only to rounding errors.
std::string CameraFileText(const CameraCalibration& calibration);

}  // namespace tessera
