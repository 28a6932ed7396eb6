#include "io/open3d_camera.h"

#include <fmt/format.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "core/input_file.h"

namespace tessera {
namespace {

// nullopt if a number is missing.
std::optional<PinholeCamera> Open3dPinhole(const nlohmann::json& json) {
    const auto number = [&json](const nlohmann::json::json_pointer& key) {
        return json.contains(key) && json.at(key).is_number() ? json.at(key).get<double>() : -1;
    };
    constexpr double kMost_px = 65535;
    const double width = number("/width"_json_pointer), height = number("/height"_json_pointer);
    if (!(width >= 1 && width <= kMost_px && height >= 1 && height <= kMost_px))
        return std::nullopt;
    return PinholeCamera{static_cast<int>(width),
                         static_cast<int>(height),
                         number("/intrinsic_matrix/0"_json_pointer),
                         number("/intrinsic_matrix/4"_json_pointer),
                         number("/intrinsic_matrix/6"_json_pointer),
                         number("/intrinsic_matrix/7"_json_pointer)};
}

Result<CameraCalibration> ParseOpen3dCamera(const std::string& path) {
    constexpr std::size_t kMostBytes = 1 << 20;
    const Result<std::string> text = ReadWholeFile(path, kMostBytes);
    if (!text.ok()) return text.status();
    const nlohmann::json json = nlohmann::json::parse(text.value(), nullptr, false);
    const std::optional<PinholeCamera> pinhole =
        json.is_object() ? Open3dPinhole(json) : std::nullopt;
    if (!pinhole)
        return Status::Error(path + ": has no width, height and intrinsic_matrix of 9 numbers");
    if (Status status = CheckPlausible(*pinhole); !status.ok())
        return Status::Error(fmt::format("{}: {}", path, status.message()));
    CameraCalibration calibration;
    calibration.pinhole = *pinhole;
    calibration.depth_scale = 1000;
    return calibration;
}

}  // namespace

Result<std::optional<Open3dCamera>> ReadOpen3dCamera(const std::string& folder) {
    for (const char* name : {"intrinsic.json", "camera_intrinsic.json", "camera_primesense.json"}) {
        const std::string path = (std::filesystem::path(folder) / name).string();
        std::error_code ignored;
        if (!std::filesystem::exists(path, ignored)) continue;
        const Result<CameraCalibration> read = ParseOpen3dCamera(path);
        if (!read.ok()) return read.status();
        return std::optional(Open3dCamera{name, read.value()});
    }
    return std::optional<Open3dCamera>();
}

}  // namespace tessera
