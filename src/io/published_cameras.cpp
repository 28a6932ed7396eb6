#include "io/published_cameras.h"

namespace tessera {

std::optional<CameraCalibration> PublishedCamera(std::string_view name) {
    constexpr double kTumDepthScale = 5000, kMillimetres = 1000;
    if (name == "freiburg1")
        return CameraCalibration{{640, 480, 517.3, 516.5, 318.6, 255.3},
                                 {0.2624, -0.9531, -0.0054, 0.0026, 1.1633},
                                 kTumDepthScale};
    if (name == "freiburg2")
        return CameraCalibration{{640, 480, 520.9, 521.0, 325.1, 249.7},
                                 {0.2312, -0.7849, -0.0033, -0.0001, 0.9172},
                                 kTumDepthScale};
    if (name == "freiburg3")
        return CameraCalibration{{640, 480, 535.4, 539.2, 320.1, 247.6}, {}, kTumDepthScale};
    if (name == "icl_nuim")
        return CameraCalibration{{640, 480, 481.2, 480.0, 319.5, 239.5}, {}, kTumDepthScale};
    if (name == "seven_scenes") {
        CameraCalibration camera{{640, 480, 585.0, 585.0, 320.0, 240.0}, {}, kMillimetres};
        ColourCamera& colour = camera.colour.emplace();
        colour.pinhole = {640, 480, 525.0, 525.0, 320.0, 240.0};
        colour.T_colour_depth.linear() =
            Eigen::Quaterniond(0.999983, 0.004081, -0.003947, -0.001354)
                .normalized()
                .toRotationMatrix();
        colour.T_colour_depth.translation() = Eigen::Vector3d(-0.0256, 0.0001, 0.0020);
        return camera;
    }
    return std::nullopt;
}

}  // namespace tessera
