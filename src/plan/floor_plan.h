// A floor plan: what is drawn, measured and written. Metres; plan frame: z up, the floor at z = 0,
// x along the main direction of the walls.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/mesh.h"
#include "core/se3.h"
#include "core/status.h"
#include "plan/plan_geometry.h"

namespace tessera {

struct PlanWall {
    // Along the middle of a wall seen from both sides, else along the face that was seen.
    Eigen::Vector2d begin = Eigen::Vector2d::Zero(), end = Eigen::Vector2d::Zero();
    Eigen::Vector2d normal = Eigen::Vector2d::UnitX();  // to a side from which it was seen
    std::optional<double> thickness_m;                  // if both faces were seen
    std::optional<double> height_m;                     // up to which it was seen
    double rms_m = 0;                                   // of its surface from the straight line
    bool seen = true;  // false: not seen, drawn because the rooms' outlines need it

    double Length() const { return (end - begin).norm(); }
};

struct PlanOpening {
    Eigen::Vector2d begin = Eigen::Vector2d::Zero(), end = Eigen::Vector2d::Zero();  // as PlanWall
    Eigen::Vector2d normal = Eigen::Vector2d::UnitX();
    std::optional<double> thickness_m;  // of the wall
    std::optional<double> height_m;     // of the lintel, if it was seen

    double Width() const { return (end - begin).norm(); }
};

struct PlanRoom {
    Polygon2d outline;             // counter-clockwise
    std::vector<Polygon2d> holes;  // clockwise: pillars, inner walls
    double area_m2 = 0, perimeter_m = 0;
    double walled_share = 0;                             // of the perimeter: wall seen, or opening
    Eigen::Vector2d label_at = Eigen::Vector2d::Zero();  // inside, far from the outline
};

struct PlanObject {
    std::string name;
    int id = 0;
    Polygon2d outline;
    double low_m = 0, high_m = 0;
};

struct FloorPlan {
    Eigen::Isometry3d T_plan_world = Eigen::Isometry3d::Identity();
    double tilt_rad = 0;  // see Level
    double noise_m = 0;   // standard deviation of the floor's surface from a plane
    double floor_m2 = 0;  // of floor that was seen
    std::optional<double> ceiling_m;
    std::vector<PlanWall> walls;
    std::vector<PlanOpening> openings;
    std::vector<PlanRoom> rooms;  // closed ones, largest first
    std::vector<PlanObject> objects;
    Eigen::Vector2d first_view = Eigen::Vector2d::UnitY();  // where the first camera looked
    std::vector<Eigen::Vector2d> floor_cells;  // centres of the squares of CellSet with floor
    std::size_t skipped_triangles = 0;
};

struct FloorPlanOptions {
    // All lengths that decide are multiples of the noise. 0: that of the floor.
    double noise_m = 0;
    double least_room_m2 = 1;
};

// `path` (world frame) shows which way is up. Errors: no surface, no floor, absurd extents. A mesh
// without walls or closed rooms gives a plan without them. Thread-safe.
Result<FloorPlan> MakeFloorPlan(const TriangleMesh& mesh, const std::vector<StampedPose>& path,
                                const FloorPlanOptions& options);

}  // namespace tessera
