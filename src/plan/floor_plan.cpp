#include "plan/floor_plan.h"

#include <fmt/format.h>

#include <numbers>

#include "export/level.h"
#include "plan/plan_rooms.h"

namespace tessera {
namespace {

constexpr double kLeastNoise_m = 0.005, kMostNoise_m = 0.03;
constexpr double kShortEnd_m = 1;  // of a wall whose other face was not seen so far

PlanWall WallOf(const WallStrip& strip, const Interval& part, bool both) {
    PlanWall wall;
    const bool front =
        both || strip.thickness_m == 0 || OverlapWith(strip.front_seen, part) >= part.Length() / 2;
    const double back_m = both ? strip.thickness_m / 2 : front ? 0 : strip.thickness_m;
    wall.begin = strip.front.At(part.low) - back_m * strip.front.normal;
    wall.end = strip.front.At(part.high) - back_m * strip.front.normal;
    wall.normal = front ? strip.front.normal : Eigen::Vector2d(-strip.front.normal);
    if (both) wall.thickness_m = strip.thickness_m;
    if (strip.height_m > 0) wall.height_m = strip.height_m;
    wall.rms_m = strip.rms_m;
    return wall;
}

void AddStrip(const WallStrip& strip, FloorPlan& plan) {
    std::vector<Interval> both = Without(strip.solid, Without(strip.solid, strip.both));
    // Short ends where only one face was seen have the wall's thickness, too.
    const std::vector<Interval> seen_both = both;
    for (const Interval& rest : Without(strip.solid, seen_both))
        if (rest.Length() < kShortEnd_m && strip.thickness_m > 0 && !seen_both.empty())
            both.push_back(rest);
    both = Joined(std::move(both), 1e-6);
    for (const Interval& part : both) plan.walls.push_back(WallOf(strip, part, true));
    for (const Interval& part : Without(strip.solid, both))
        plan.walls.push_back(WallOf(strip, part, false));
    for (const StripOpening& at : strip.openings) {
        const bool thick = strip.thickness_m > 0;
        PlanOpening opening;
        const Eigen::Vector2d back = strip.thickness_m / 2 * strip.front.normal;
        opening.begin = strip.front.At(at.along.low) - back;
        opening.end = strip.front.At(at.along.high) - back;
        opening.normal = strip.front.normal;
        if (thick) opening.thickness_m = strip.thickness_m;
        opening.height_m = at.height_m;
        plan.openings.push_back(opening);
    }
}

// Turns the plan about z.
void Turn(double angle_rad, FloorPlan& plan) {
    const Eigen::Matrix2d R = Eigen::Rotation2Dd(angle_rad).toRotationMatrix();
    const auto turn = [&](auto&... vectors) { ((vectors = (R * vectors).eval()), ...); };
    const auto turn_all = [&](Polygon2d& points) {
        for (Eigen::Vector2d& point : points) turn(point);
    };
    for (PlanWall& wall : plan.walls) turn(wall.begin, wall.end, wall.normal);
    for (PlanOpening& opening : plan.openings) turn(opening.begin, opening.end, opening.normal);
    for (PlanRoom& room : plan.rooms) {
        turn_all(room.outline);
        for (Polygon2d& hole : room.holes) turn_all(hole);
        turn(room.label_at);
    }
    turn(plan.first_view);
    turn_all(plan.floor_cells);
    plan.T_plan_world = Eigen::AngleAxisd(angle_rad, Eigen::Vector3d::UnitZ()) * plan.T_plan_world;
}

// The turn that brings the longest wall's direction onto an axis, by an eighth of a turn at most.
double TurnToMain(const std::vector<PlanWall>& walls) {
    const auto longest = std::ranges::max_element(walls, {}, &PlanWall::Length);
    if (longest == walls.end()) return 0;
    const Eigen::Vector2d along = longest->end - longest->begin;
    return -std::remainder(std::atan2(along.y(), along.x()), std::numbers::pi / 2);
}

}  // namespace

Result<FloorPlan> MakeFloorPlan(const TriangleMesh& mesh, const std::vector<StampedPose>& path,
                                const FloorPlanOptions& options) {
    Result<MeshSamples> samples = SampleMesh(mesh);
    if (!samples.ok()) return samples.status();
    std::vector<StampedPose> level_path = path;
    const Result<Level> level = FindLevel(samples.value().surface, path);
    if (!level.ok()) return level.status();
    MakeLevel(level.value(), samples.value().surface, level_path);

    FloorPlan plan;
    plan.T_plan_world = level.value().T_level_world;
    plan.tilt_rad = level.value().tilt_rad;
    plan.skipped_triangles = samples.value().skipped;
    plan.noise_m = options.noise_m > 0
                       ? options.noise_m
                       : std::clamp(level.value().roughness_m, kLeastNoise_m, kMostNoise_m);
    const PlanEvidence evidence = FindEvidence(samples.value());
    samples.value() = {};  // as large as the evidence
    plan.ceiling_m = evidence.ceiling_m;
    plan.floor_cells = evidence.floor.Centres();
    plan.floor_m2 =
        static_cast<double>(plan.floor_cells.size()) * CellSet::kSide_m * CellSet::kSide_m;
    WallFaceOptions faces;
    faces.noise_m = plan.noise_m;
    const std::vector<WallStrip> strips =
        FindWallStrips(evidence, FindWallFaces(evidence, faces), plan.noise_m);
    RoomResult rooms = FindRooms(evidence, strips, options.least_room_m2);
    for (const WallStrip& strip : strips) AddStrip(strip, plan);
    plan.walls.insert(plan.walls.end(), rooms.unseen_walls.begin(), rooms.unseen_walls.end());
    plan.rooms = std::move(rooms.rooms);
    Turn(TurnToMain(plan.walls), plan);
    return plan;
}

}  // namespace tessera
