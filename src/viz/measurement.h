// What is measured on a surface by clicks: lengths and angles of a line, the area of a polygon, the
// volume of the body over it. Pure functions, thread-safe. All points are in the world frame, in
// metres.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/status.h"

namespace tessera {

struct Measurement {
    std::vector<Eigen::Vector3d> corners;
    bool closed = false;                 // a polygon; of three corners or more
    std::optional<Eigen::Vector3d> top;  // of a polygon: the body over it ends at this height
};

// The edge from corner `i` to the next, which after the last of a polygon is the first.
struct MeasuredEdge {
    Eigen::Vector3d from, to;
    double length_m() const { return (to - from).norm(); }
};
std::vector<MeasuredEdge> EdgesOf(const Measurement& m);
// Of all edges.
double Length_m(const Measurement& m);
// Between the two edges at a corner, in degrees; nullopt at the ends of a line, or where an edge
// has no length.
std::optional<double> Angle_deg(const Measurement& m, std::size_t corner);
// Of a polygon, seen at a right angle to its mean plane. The corners must be in order around it. 0
// of a line.
double Area_m2(const Measurement& m);
// Of the corner that lies farthest from the polygon's mean plane. 0 of a line.
double Unevenness_m(const Measurement& m);
// From the polygon's mean plane to its top, and the volume between the two; 0 without a top.
double Height_m(const Measurement& m);
double Volume_m3(const Measurement& m);
// The polygon, moved at a right angle to its mean plane up to the top. Empty without a top.
std::vector<Eigen::Vector3d> TopCorners(const Measurement& m);

// {"measurements": [...]}: the points, and for other programs the figures.
std::string MeasurementsJson(std::span<const Measurement> measurements);
// Reads the points back. Errors name the file and the measurement.
Result<std::vector<Measurement>> ReadMeasurements(const std::string& path);

}  // namespace tessera
