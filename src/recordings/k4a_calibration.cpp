#include "recordings/k4a_calibration.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <tuple>
#include <vector>

#include "recordings/lens_fit.h"

namespace tessera {
namespace {

using K4aJson = nlohmann::json;

constexpr double kK4aUnitsPerMetre = 1000;
constexpr double kMostK4aRadius = 1.7;  // the SDK's usual limit of |ideal| for this lens model
constexpr int kK4aSensorSide = 1024;    // of the depth camera

// The part of the depth sensor, perhaps at half its size, that a mode delivers.
struct K4aDepthMode {
    ImageSize image;
    int sensor_side, left, top;  // pixels of the image
};
constexpr std::array kK4aDepthModes{
    K4aDepthMode{{640, 576}, 1024, 192, 180}, K4aDepthMode{{320, 288}, 512, 96, 90},
    K4aDepthMode{{1024, 1024}, 1024, 0, 0}, K4aDepthMode{{512, 512}, 512, 0, 0}};

// `left` and `top` are cut off an image of the whole sensor, in pixels.
PinholeCamera K4aPart(const K4aCamera& camera, ImageSize whole, int left, int top,
                      ImageSize image) {
    constexpr double kCentre = 0.5;  // of a pixel, from its corner
    return {image.width,
            image.height,
            camera.fx * whole.width,
            camera.fy * whole.height,
            camera.cx * whole.width - left - kCentre,
            camera.cy * whole.height - top - kCentre};
}

std::optional<PinholeCamera> K4aDepthPinhole(const K4aCamera& camera, ImageSize image) {
    for (const K4aDepthMode& mode : kK4aDepthModes)
        if (mode.image == image)
            return K4aPart(camera, {mode.sensor_side, mode.sensor_side}, mode.left, mode.top,
                           image);
    return std::nullopt;
}

// Images of 16 : 9 lack rows of the sensor at the top and bottom.
std::optional<PinholeCamera> K4aColourPinhole(const K4aCamera& camera, ImageSize image) {
    const ImageSize whole{image.width, image.width / 4 * 3};
    if (image.width % 16 != 0 ||
        (image.height != whole.height && image.height != image.width / 16 * 9))
        return std::nullopt;
    return K4aPart(camera, whole, 0, (whole.height - image.height) / 2, image);
}

// Directions of pixels all over the image.
std::vector<Eigen::Vector2d> K4aDirections(const PinholeCamera& camera) {
    constexpr int kSide = 20;
    std::vector<Eigen::Vector2d> directions;
    for (int j = 0; j < kSide; ++j)
        for (int i = 0; i < kSide; ++i)
            directions.push_back(camera
                                     .Unproject((camera.width - 1.0) * i / (kSide - 1),
                                                (camera.height - 1.0) * j / (kSide - 1), 1)
                                     .head<2>());
    return directions;
}

// What the colour camera sees of that, near and far.
std::vector<LensPoint> K4aColourPoints(const std::vector<Eigen::Vector2d>& depth_directions,
                                       const Eigen::Isometry3d& T_colour_depth,
                                       const K4aCamera& camera, const PinholeCamera& pinhole) {
    constexpr double kNear_m = 0.5, kFar_m = 5;
    constexpr double kMargin = 0.01;  // of the image, so that nothing outside is bent into it
    const auto inside = [&](double value, int side) {
        return value >= -kMargin * side && value <= (1 + kMargin) * side;
    };
    std::vector<LensPoint> points;
    for (const double z_m : {kNear_m, kFar_m})
        for (const Eigen::Vector2d& direction : depth_directions) {
            const Eigen::Vector3d p_colour = T_colour_depth * (z_m * direction.homogeneous());
            if (p_colour.z() <= 0) continue;
            const LensPoint point{p_colour.hnormalized(), camera.Distort(p_colour.hnormalized())};
            const Eigen::Vector2d pixel = pinhole.Project(point.seen.homogeneous());
            if (point.ideal.norm() < kMostK4aRadius && inside(pixel.x(), pinhole.width) &&
                inside(pixel.y(), pinhole.height))
                points.push_back(point);
        }
    return points;
}

Eigen::Isometry3d ReadK4aTransform(const K4aJson& json) {
    const auto r = json.at("Rotation").get<std::vector<double>>();
    const auto t = json.at("Translation").get<std::vector<double>>();
    if (r.size() != 9 || t.size() != 3) throw std::invalid_argument("Rt has too few numbers");
    const Eigen::Matrix3d rotation =
        Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(r.data());
    const Eigen::Vector3d translation_m(t[0], t[1], t[2]);
    if (!(rotation * rotation.transpose()).isIdentity(1e-3) || rotation.determinant() < 0 ||
        !(translation_m.norm() < 1))
        throw std::invalid_argument("Rt is no rotation and translation of two cameras");
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    T.linear() = Eigen::Quaterniond(rotation).normalized().toRotationMatrix();
    T.translation() = translation_m;
    return T;
}

K4aCamera ReadK4aCamera(const K4aJson& json) {
    const K4aJson& intrinsics = json.at("Intrinsics");
    const auto type = intrinsics.at("ModelType").get<std::string>();
    const auto v = intrinsics.at("ModelParameters").get<std::vector<double>>();
    K4aCamera camera;
    if (type == "CALIBRATION_LensDistortionModelRational6KT")
        camera.mixed = 1;
    else if (type != "CALIBRATION_LensDistortionModelBrownConrady")
        throw std::invalid_argument("unknown lens model " + type);
    if (v.size() < 14) throw std::invalid_argument("a lens has too few numbers");
    for (const double value : v)
        if (!(std::abs(value) < 1e3)) throw std::invalid_argument("a lens is not plausible");
    std::tie(camera.cx, camera.cy, camera.fx, camera.fy) = std::tie(v[0], v[1], v[2], v[3]);
    std::copy_n(v.begin() + 4, camera.k.size(), camera.k.begin());
    camera.distortion_centre = {v[10], v[11]};
    camera.p2 = v[12];
    camera.p1 = v[13];
    camera.T_camera_device = ReadK4aTransform(json.at("Rt"));
    return camera;
}

const K4aJson& FindK4aCamera(const K4aJson& cameras, const std::string& location) {
    for (const K4aJson& camera : cameras)
        if (camera.at("Location") == location) return camera;
    throw std::invalid_argument("no camera " + location);
}

K4aCamera ReadK4aDepthCamera(const K4aJson& json) {
    if (json.at("SensorWidth") != kK4aSensorSide || json.at("SensorHeight") != kK4aSensorSide)
        throw std::invalid_argument("the depth sensor's size is unknown");
    return ReadK4aCamera(json);
}

K4aCamera ReadK4aColourCamera(const K4aJson& json) {
    const auto width = json.at("SensorWidth").get<double>(),
               height = json.at("SensorHeight").get<double>();
    K4aCamera camera = ReadK4aCamera(json);
    if (width * 9 == height * 16) {  // of early devices: the numbers hold for the middle rows
        camera.cy = (camera.cy * 9 + 1.5) / 12;
        camera.fy = camera.fy * 9 / 12;
    } else if (width * 3 != height * 4) {
        throw std::invalid_argument("the colour sensor's size is unknown");
    }
    return camera;
}

}  // namespace

Eigen::Vector2d K4aCamera::Distort(const Eigen::Vector2d& ideal) const {
    const Eigen::Vector2d p = ideal - distortion_centre;
    const double r2 = p.squaredNorm(), xy = p.x() * p.y();
    const double radial =
        (1 + r2 * (k[0] + r2 * (k[1] + r2 * k[2]))) / (1 + r2 * (k[3] + r2 * (k[4] + r2 * k[5])));
    const Eigen::Vector2d tangential(p2 * (r2 + 2 * p.x() * p.x()) + mixed * p1 * xy,
                                     p1 * (r2 + 2 * p.y() * p.y()) + mixed * p2 * xy);
    return radial * p + tangential + distortion_centre;
}

Result<K4aCalibration> ParseK4aCalibration(std::string_view json) {
    try {
        const K4aJson cameras = K4aJson::parse(json).at("CalibrationInformation").at("Cameras");
        return K4aCalibration{
            ReadK4aDepthCamera(FindK4aCamera(cameras, "CALIBRATION_CameraLocationD0")),
            ReadK4aColourCamera(FindK4aCamera(cameras, "CALIBRATION_CameraLocationPV0"))};
    } catch (const std::exception& error) {
        return Status::Error(error.what());
    }
}

// After the device whose file is in github.com/etiennedub/pyk4a, tests/assets.
K4aCalibration UsualK4aCalibration() {
    K4aCalibration usual;
    usual.depth.fx = usual.depth.fy = 0.4928;
    usual.depth.k = {0.5479, -0.0210, -0.0027, 0.8897, 0.0861, -0.0139};
    usual.colour.fx = 0.478;
    usual.colour.fy = 0.6374;
    usual.colour.k = {0.3301, -2.4894, 1.4537, 0.2089, -2.3029, 1.3751};
    usual.colour.T_camera_device.linear() =
        Eigen::AngleAxisd(-0.0863, Eigen::Vector3d::UnitX()).toRotationMatrix();
    usual.colour.T_camera_device.translation() = Eigen::Vector3d(-0.0321, -0.0022, 0.0039);
    return usual;
}

Result<K4aCameras> MakeK4aCameras(const K4aCalibration& calibration, ImageSize depth_size,
                                  ImageSize colour_size) {
    const auto no_mode = [](const char* what, ImageSize size) {
        return Status::Error(fmt::format("{} of {} x {} pixels is in no mode of an Azure Kinect",
                                         what, size.width, size.height));
    };
    K4aCameras cameras;
    const auto depth = K4aDepthPinhole(calibration.depth, depth_size);
    if (!depth) return no_mode("depth", depth_size);
    cameras.depth.pinhole = *depth;
    cameras.depth.depth_scale = kK4aUnitsPerMetre;
    const std::vector<Eigen::Vector2d> directions = K4aDirections(*depth);
    std::vector<LensPoint> points;
    for (const Eigen::Vector2d& direction : directions)
        points.push_back({direction, calibration.depth.Distort(direction)});
    LensFit fit = FitLens(points, depth->fx);
    cameras.depth.distortion = fit.lens;
    cameras.depth_error_px = fit.largest_px;
    cameras.colour = cameras.depth;
    if (colour_size == ImageSize{}) return cameras;

    const auto colour = K4aColourPinhole(calibration.colour, colour_size);
    if (!colour) return no_mode("colour", colour_size);
    cameras.colour.pinhole = *colour;
    cameras.T_colour_depth =
        calibration.colour.T_camera_device * calibration.depth.T_camera_device.inverse();
    fit = FitLens(K4aColourPoints(directions, cameras.T_colour_depth, calibration.colour, *colour),
                  colour->fx);
    cameras.colour.distortion = fit.lens;
    cameras.colour_error_px = fit.largest_px;
    return cameras;
}

}  // namespace tessera
