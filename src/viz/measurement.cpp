#include "viz/measurement.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <stdexcept>

#include "core/input_file.h"
#include "core/printable.h"

namespace tessera {
namespace {

using Json = nlohmann::json;

struct MeanPlane {
    Eigen::Vector3d centre = Eigen::Vector3d::Zero();
    Eigen::Vector3d area = Eigen::Vector3d::Zero();  // normal times area, m2 (Newell's method)

    Eigen::Vector3d normal() const { return area.normalized(); }
    double Height_m(const Eigen::Vector3d& p) const { return normal().dot(p - centre); }
};

bool IsPolygon(const Measurement& m) { return m.closed && m.corners.size() >= 3; }

MeanPlane PlaneOf(const Measurement& m) {
    MeanPlane plane;
    for (const Eigen::Vector3d& corner : m.corners)
        plane.centre += corner / static_cast<double>(m.corners.size());
    for (const MeasuredEdge& edge : EdgesOf(m))
        plane.area += 0.5 * (edge.from - plane.centre).cross(edge.to - plane.centre);
    return plane;
}

Json ToJson(const Eigen::Vector3d& p) { return Json::array({p.x(), p.y(), p.z()}); }

// Throws if it is not a point.
Eigen::Vector3d ToPoint(const Json& json) {
    if (!json.is_array() || json.size() != 3) throw std::out_of_range("a point has three numbers");
    const Eigen::Vector3d p(json.at(0).get<double>(), json.at(1).get<double>(),
                            json.at(2).get<double>());
    constexpr double kFarthest_m = 1e6;
    if (!(p.cwiseAbs().maxCoeff() <= kFarthest_m))
        throw std::out_of_range("a point is too far away");
    return p;
}

// Throws a JSON exception if a field is missing or has the wrong type.
Measurement ToMeasurement(const Json& json) {
    Measurement m;
    for (const Json& corner : json.at("corners")) m.corners.push_back(ToPoint(corner));
    m.closed = json.at("closed").get<bool>();
    if (json.contains("top")) m.top = ToPoint(json.at("top"));
    if (m.corners.size() < 2) throw std::out_of_range("it has fewer than two corners");
    if (m.closed && m.corners.size() < 3) throw std::out_of_range("an area has three corners");
    if (m.top && !m.closed) throw std::out_of_range("a line has no top");
    return m;
}

}  // namespace

std::vector<MeasuredEdge> EdgesOf(const Measurement& m) {
    std::vector<MeasuredEdge> edges;
    for (std::size_t i = 1; i < m.corners.size(); ++i)
        edges.push_back({m.corners[i - 1], m.corners[i]});
    if (IsPolygon(m)) edges.push_back({m.corners.back(), m.corners.front()});
    return edges;
}

double Length_m(const Measurement& m) {
    double length = 0;
    for (const MeasuredEdge& edge : EdgesOf(m)) length += edge.length_m();
    return length;
}

std::optional<double> Angle_deg(const Measurement& m, std::size_t corner) {
    const std::size_t count = m.corners.size();
    const bool at_end = corner == 0 || corner + 1 >= count;
    if (corner >= count || (at_end && !IsPolygon(m))) return std::nullopt;
    const Eigen::Vector3d back = m.corners[(corner + count - 1) % count] - m.corners[corner],
                          on = m.corners[(corner + 1) % count] - m.corners[corner];
    if (back.norm() <= 0 || on.norm() <= 0) return std::nullopt;
    return std::atan2(back.cross(on).norm(), back.dot(on)) * 180 / std::numbers::pi;
}

double Area_m2(const Measurement& m) { return IsPolygon(m) ? PlaneOf(m).area.norm() : 0; }

double Unevenness_m(const Measurement& m) {
    if (!IsPolygon(m)) return 0;
    const MeanPlane plane = PlaneOf(m);
    double most = 0;
    for (const Eigen::Vector3d& corner : m.corners)
        most = std::max(most, std::abs(plane.Height_m(corner)));
    return most;
}

double Height_m(const Measurement& m) {
    return IsPolygon(m) && m.top ? std::abs(PlaneOf(m).Height_m(*m.top)) : 0;
}

double Volume_m3(const Measurement& m) { return Area_m2(m) * Height_m(m); }

std::vector<Eigen::Vector3d> TopCorners(const Measurement& m) {
    std::vector<Eigen::Vector3d> corners;
    if (!IsPolygon(m) || !m.top) return corners;
    const MeanPlane plane = PlaneOf(m);
    for (const Eigen::Vector3d& corner : m.corners)
        corners.push_back(corner +
                          (plane.Height_m(*m.top) - plane.Height_m(corner)) * plane.normal());
    return corners;
}

std::string MeasurementsJson(std::span<const Measurement> measurements) {
    Json list = Json::array();
    for (const Measurement& m : measurements) {
        Json one = Json::object(), corners = Json::array(), edges = Json::array(),
             angles = Json::array();
        for (std::size_t i = 0; i < m.corners.size(); ++i) {
            corners.push_back(ToJson(m.corners[i]));
            const std::optional<double> angle = Angle_deg(m, i);
            angles.push_back(angle ? Json(*angle) : Json());
        }
        for (const MeasuredEdge& edge : EdgesOf(m)) edges.push_back(edge.length_m());
        one["corners"] = corners;
        one["closed"] = m.closed;
        one["edges_m"] = edges;
        one["length_m"] = Length_m(m);
        one["angles_deg"] = angles;
        if (m.closed) {
            one["area_m2"] = Area_m2(m);
            one["unevenness_m"] = Unevenness_m(m);
        }
        if (m.top) {
            one["top"] = ToJson(*m.top);
            one["height_m"] = Height_m(m);
            one["volume_m3"] = Volume_m3(m);
        }
        list.push_back(one);
    }
    Json file = Json::object();
    file["measurements"] = list;
    return file.dump(2) + "\n";
}

Result<std::vector<Measurement>> ReadMeasurements(const std::string& path) {
    constexpr std::size_t kMostBytes = std::size_t{1} << 24;
    const Result<std::string> text = ReadWholeFile(path, kMostBytes);
    if (!text.ok()) return text.status();
    const Json json = Json::parse(text.value(), nullptr, false);
    if (!json.is_object() || !json.contains("measurements") || !json["measurements"].is_array())
        return Status::Error(path + ": has no list \"measurements\"");
    std::vector<Measurement> measurements;
    try {
        for (const Json& one : json["measurements"]) measurements.push_back(ToMeasurement(one));
    } catch (const std::exception& error) {
        return Status::Error(fmt::format("{}: measurement {}: {}", path, measurements.size(),
                                         Printable(error.what(), 200)));
    }
    return measurements;
}

}  // namespace tessera
