// What all drawings of a plan share: outlines of walls, dimension lines, bounds. Plan frame,
// metres. Pure functions, thread-safe.
#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "plan/floor_plan.h"

namespace tessera {

// A wall of which only one face was seen is drawn this thick behind the face.
inline constexpr double kDrawnThickness_m = 0.05;

// Four corners, mitred where walls meet.
Polygon2d WallOutline(const FloorPlan& plan, const PlanWall& wall);
// Four corners of the place of an opening in its wall: begin and end on the front, then behind.
Polygon2d OpeningOutline(const PlanOpening& opening);

struct PlanDimension {
    Eigen::Vector2d from, to;  // of the dimension line
    Eigen::Vector2d away;      // from the wall, of the length of the extension lines
    double length_m = 0;
};

// Of the sides of rooms, inside; of walls that belong to no room, before them. Sides that repeat
// another one of the same room have none.
std::vector<PlanDimension> Dimensions(const FloorPlan& plan);

std::string MeasureText(double length_m);  // "3.42"

// Of walls, rooms, objects and floor; a square metre if there is nothing.
Eigen::AlignedBox2d Bounds(const FloorPlan& plan);

}  // namespace tessera
