#include "core/camera.h"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <type_traits>

#include "core/input_file.h"

namespace tessera {
namespace {

Status NotPlausible(const char* key, double value) {
    return Status::Error(fmt::format("{}: {} is not plausible", key, value));
}

// How far the lens moves a point of the image's border, in image diagonals.
double LargestShift(const CameraCalibration& c) {
    const PinholeCamera& p = c.pinhole;
    const LensDistortion& d = c.distortion;
    double largest = 0;
    for (const double u : {0.0, 0.5 * p.width, 1.0 * p.width})
        for (const double v : {0.0, 0.5 * p.height, 1.0 * p.height}) {
            const double x = (u - p.cx) / p.fx, y = (v - p.cy) / p.fy, r2 = x * x + y * y;
            const double radial = r2 * (d.k1 + r2 * (d.k2 + r2 * d.k3));
            const double dx = x * radial + 2 * d.p1 * x * y + d.p2 * (r2 + 2 * x * x);
            const double dy = y * radial + d.p1 * (r2 + 2 * y * y) + 2 * d.p2 * x * y;
            const double shift = std::hypot(p.fx * dx, p.fy * dy);
            if (!(shift <= largest)) largest = shift;  // also if it is not a number
        }
    return largest / std::hypot(p.width, p.height);
}

Status CheckPlausible(const CameraCalibration& c) {
    constexpr double kLargestShift = 1.0;
    if (Status status = CheckPlausible(c.pinhole); !status.ok()) return status;
    if (!(LargestShift(c) <= kLargestShift))
        return Status::Error(
            "distortion: is not plausible, it moves the image's border by more than its diagonal "
            "(expected k1, k2, p1, p2, k3 as OpenCV gives them)");
    if (!(c.depth_scale > 0 && c.depth_scale < 1e7))
        return NotPlausible("depth_scale", c.depth_scale);
    if (!(c.fps > 0 && c.fps < 1e4)) return NotPlausible("fps", c.fps);
    return Status::Ok();
}

// A value as it is in the file, for a message.
std::string Quoted(const YAML::Node& node) {
    return node.IsScalar() ? "'" + Printable(node.Scalar(), kQuotedBytes) + "'" : "a list";
}

template <class Number>
Status Read(const YAML::Node& node, Number& number) {
    if (YAML::convert<Number>::decode(node, number)) return Status::Ok();
    return Status::Error(Quoted(node) + " is not " +
                         (std::is_integral_v<Number> ? "a whole number" : "a number"));
}

Status ReadLens(const YAML::Node& node, LensDistortion& lens) {
    double* const numbers[] = {&lens.k1, &lens.k2, &lens.p1, &lens.p2, &lens.k3};
    if (!node.IsSequence() || node.size() < 4 || node.size() > 5)
        return Status::Error("needs k1, k2, p1, p2 and optionally k3");
    for (std::size_t i = 0; i < node.size(); ++i)
        if (Status status = Read(node[i], *numbers[i]); !status.ok()) return status;
    return Status::Ok();
}

Status ReadEntry(const std::string& key, const YAML::Node& value, CameraCalibration& c) {
    PinholeCamera& p = c.pinhole;
    const std::map<std::string, double*> numbers = {
        {"fx", &p.fx}, {"fy", &p.fy},   {"cx", &p.cx},
        {"cy", &p.cy}, {"fps", &c.fps}, {"depth_scale", &c.depth_scale}};
    if (const auto number = numbers.find(key); number != numbers.end())
        return Read(value, *number->second);
    if (key == "width" || key == "height") return Read(value, key == "width" ? p.width : p.height);
    return ReadLens(value, c.distortion);
}

Status ParseCamera(const YAML::Node& root, CameraCalibration& c) {
    const std::set<std::string> known = {"width", "height", "fx",          "fy",        "cx",
                                         "cy",    "fps",    "depth_scale", "distortion"};
    std::set<std::string> seen;
    if (!root.IsMap()) return Status::Error("expected 'key: value' lines");
    for (const auto& entry : root) {
        const std::string key = entry.first.IsScalar() ? entry.first.Scalar() : "?";
        const std::string shown = Printable(key, kQuotedBytes);
        if (!known.contains(key))
            return Status::Error(
                fmt::format("unknown key '{}' (known: width, height, fx, fy, cx, cy, distortion, "
                            "depth_scale, fps)",
                            shown));
        if (!seen.insert(key).second) return Status::Error(shown + ": is given twice");
        if (Status status = ReadEntry(key, entry.second, c); !status.ok())
            return Status::Error(shown + ": " + status.message());
    }
    for (const char* key : {"cx", "cy", "fx", "fy"})
        if (!seen.contains(key)) return Status::Error(fmt::format("'{}' is missing", key));
    c.depth_scale_given = seen.contains("depth_scale");
    // ICL-NUIM's intrinsics have the y axis pointing up, but its images do not.
    c.pinhole.fy = std::abs(c.pinhole.fy);
    return CheckPlausible(c);
}

}  // namespace

Status CheckPlausible(const PinholeCamera& p) {
    for (const auto& [key, value] : std::map<const char*, double>{{"fx", p.fx}, {"fy", p.fy}})
        if (!(value > 1.0 && value < 1e5)) return NotPlausible(key, value);
    if (p.width < 16 || p.width > 8192) return NotPlausible("width", p.width);
    if (p.height < 16 || p.height > 8192) return NotPlausible("height", p.height);
    const auto outside = [](const char* key, double value, int side_px) {
        return Status::Error(fmt::format(
            "{}: {} is not plausible, it is outside the image (0 to {})", key, value, side_px));
    };
    if (!(p.cx >= 0 && p.cx <= p.width)) return outside("cx", p.cx, p.width);
    if (!(p.cy >= 0 && p.cy <= p.height)) return outside("cy", p.cy, p.height);
    return Status::Ok();
}

Result<CameraCalibration> ReadCameraFile(const std::string& path) {
    constexpr std::size_t kMostBytes = 64 << 10;
    const Result<std::string> text = ReadWholeFile(path, kMostBytes);
    if (!text.ok()) return text.status();
    return ParseCameraText(text.value(), path);
}

Result<CameraCalibration> ParseCameraText(const std::string& text, const std::string& name) {
    CameraCalibration calibration;
    try {
        if (Status status = ParseCamera(YAML::Load(text), calibration); !status.ok())
            return Status::Error(name + ": " + status.message());
    } catch (const YAML::Exception& error) {
        return Status::Error(
            fmt::format("{}: is not valid YAML: {}", name, Printable(error.what(), 200)));
    }
    return calibration;
}

std::string CameraFileText(const CameraCalibration& calibration) {
    const PinholeCamera& p = calibration.pinhole;
    const LensDistortion& d = calibration.distortion;
    const std::string lens = d.IsZero() ? ""
                                        : fmt::format("distortion: [{}, {}, {}, {}, {}]\n", d.k1,
                                                      d.k2, d.p1, d.p2, d.k3);
    return fmt::format(
        "width: {}\nheight: {}\nfx: {}\nfy: {}\ncx: {}\ncy: {}\n{}depth_scale: {}\nfps: {}\n",
        p.width, p.height, p.fx, p.fy, p.cx, p.cy, lens, calibration.depth_scale, calibration.fps);
}

}  // namespace tessera
