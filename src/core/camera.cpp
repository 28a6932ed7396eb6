#include "core/camera.h"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <set>
#include <type_traits>
#include <utility>
#include <vector>

#include "core/input_file.h"

namespace tessera {
namespace {

Status NotPlausible(const char* key, double value) {
    return Status::Error(fmt::format("{}: {} is not plausible", key, value));
}

// How far the lens moves a point of the image's border, in image diagonals.
double LargestShift(const PinholeCamera& p, const LensDistortion& d) {
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

Status CheckLens(const PinholeCamera& pinhole, const LensDistortion& lens) {
    constexpr double kLargestShift = 1.0;
    if (Status status = CheckPlausible(pinhole); !status.ok()) return status;
    if (LargestShift(pinhole, lens) <= kLargestShift) return Status::Ok();
    return Status::Error(
        "distortion: is not plausible, it moves the image's border by more than its diagonal "
        "(expected k1, k2, p1, p2, k3 as OpenCV gives them)");
}

Status CheckCalibration(const CameraCalibration& c) {
    if (Status status = CheckLens(c.pinhole, c.distortion); !status.ok()) return status;
    if (!(c.depth_scale > 0 && c.depth_scale < 1e7))
        return NotPlausible("depth_scale", c.depth_scale);
    if (!(c.fps > 0 && c.fps < 1e4)) return NotPlausible("fps", c.fps);
    if (!(c.vignetting > -0.5 && c.vignetting < 0.9))
        return NotPlausible("vignetting", c.vignetting);
    if (!c.colour) return Status::Ok();
    const Status colour = CheckLens(c.colour->pinhole, c.colour->distortion);
    return colour.ok() ? colour : Status::Error("colour: " + colour.message());
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

// As in trajectories: tx, ty, tz in metres, and a unit quaternion qx, qy, qz, qw.
Status ReadTransform(const YAML::Node& node, Eigen::Isometry3d& T) {
    constexpr double kUnitWithin = 1e-3, kFarthest_m = 1;
    std::array<double, 7> n{};
    if (!node.IsSequence() || node.size() != n.size())
        return Status::Error("needs tx, ty, tz, qx, qy, qz, qw");
    for (std::size_t i = 0; i < n.size(); ++i)
        if (Status status = Read(node[i], n[i]); !status.ok()) return status;
    const Eigen::Quaterniond q(n[6], n[3], n[4], n[5]);
    if (!(std::abs(q.norm() - 1) < kUnitWithin))
        return Status::Error("qx, qy, qz, qw is no rotation: its length is not 1");
    T.linear() = q.normalized().toRotationMatrix();
    T.translation() = Eigen::Vector3d(n[0], n[1], n[2]);
    if (T.translation().norm() < kFarthest_m) return Status::Ok();
    return Status::Error("is not plausible, the cameras are more than a metre apart");
}

// The keys of a map, in the order in which a message lists them, and how each value is read.
using Entries = std::vector<std::pair<std::string, std::function<Status(const YAML::Node&)>>>;

template <class Number>
std::function<Status(const YAML::Node&)> Into(Number& number) {
    return [&number](const YAML::Node& node) { return Read(node, number); };
}

Entries LensEntries(PinholeCamera& p, LensDistortion& lens) {
    return {{"width", Into(p.width)},
            {"height", Into(p.height)},
            {"fx", Into(p.fx)},
            {"fy", Into(p.fy)},
            {"cx", Into(p.cx)},
            {"cy", Into(p.cy)},
            {"distortion", [&lens](const YAML::Node& node) { return ReadLens(node, lens); }}};
}

// `seen`: the keys that are there. fx, fy, cx and cy must be.
Status ReadCamera(const YAML::Node& root, const Entries& entries, std::set<std::string>& seen) {
    if (!root.IsMap()) return Status::Error("expected 'key: value' lines");
    for (const auto& entry : root) {
        const std::string key = entry.first.IsScalar() ? entry.first.Scalar() : "?";
        const std::string shown = Printable(key, kQuotedBytes);
        const auto known = std::find_if(entries.begin(), entries.end(),
                                        [&](const auto& e) { return e.first == key; });
        if (known == entries.end()) {
            std::string list;
            for (const auto& e : entries) list += (list.empty() ? "" : ", ") + e.first;
            return Status::Error(fmt::format("unknown key '{}' (known: {})", shown, list));
        }
        if (!seen.insert(key).second) return Status::Error(shown + ": is given twice");
        if (Status status = known->second(entry.second); !status.ok())
            return Status::Error(shown + ": " + status.message());
    }
    for (const char* key : {"cx", "cy", "fx", "fy"})
        if (!seen.contains(key)) return Status::Error(fmt::format("'{}' is missing", key));
    return Status::Ok();
}

Status ReadColour(const YAML::Node& root, ColourCamera& colour) {
    Entries entries = LensEntries(colour.pinhole, colour.distortion);
    entries.emplace_back("T_colour_depth", [&](const YAML::Node& node) {
        return ReadTransform(node, colour.T_colour_depth);
    });
    std::set<std::string> seen;
    return ReadCamera(root, entries, seen);
}

Status ParseCamera(const YAML::Node& root, CameraCalibration& c) {
    Entries entries = LensEntries(c.pinhole, c.distortion);
    entries.emplace_back("depth_scale", Into(c.depth_scale));
    entries.emplace_back("fps", Into(c.fps));
    entries.emplace_back("vignetting", Into(c.vignetting));
    entries.emplace_back(
        "colour", [&](const YAML::Node& node) { return ReadColour(node, c.colour.emplace()); });
    std::set<std::string> seen;
    if (Status status = ReadCamera(root, entries, seen); !status.ok()) return status;
    c.depth_scale_given = seen.contains("depth_scale");
    // ICL-NUIM's intrinsics have the y axis pointing up, but its images do not.
    c.pinhole.fy = std::abs(c.pinhole.fy);
    return CheckCalibration(c);
}

// The lines of a camera's keys, each after `indent`.
std::string LensText(const PinholeCamera& p, const LensDistortion& d, const std::string& indent) {
    std::string text;
    for (const auto& [key, pixels] : {std::pair("width", p.width), std::pair("height", p.height)})
        text += fmt::format("{}{}: {}\n", indent, key, pixels);
    for (const auto& [key, value] : {std::pair("fx", p.fx), std::pair("fy", p.fy),
                                     std::pair("cx", p.cx), std::pair("cy", p.cy)})
        text += fmt::format("{}{}: {}\n", indent, key, value);
    if (!d.IsZero())
        text += fmt::format("{}distortion: [{}, {}, {}, {}, {}]\n", indent, d.k1, d.k2, d.p1, d.p2,
                            d.k3);
    return text;
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

std::string CameraFileText(const CameraCalibration& c) {
    std::string text = LensText(c.pinhole, c.distortion, "") +
                       fmt::format("depth_scale: {}\nfps: {}\n", c.depth_scale, c.fps);
    if (c.vignetting != 0) text += fmt::format("vignetting: {}\n", c.vignetting);
    if (!c.colour) return text;
    const Eigen::Quaterniond q(c.colour->T_colour_depth.linear());
    const Eigen::Vector3d t = c.colour->T_colour_depth.translation();
    return text + "colour:\n" + LensText(c.colour->pinhole, c.colour->distortion, "  ") +
           fmt::format("  T_colour_depth: [{}, {}, {}, {}, {}, {}, {}]\n", t.x(), t.y(), t.z(),
                       q.x(), q.y(), q.z(), q.w());
}

}  // namespace tessera
