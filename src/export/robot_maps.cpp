#include "export/robot_maps.h"

#include <fmt/format.h>

#include <filesystem>

#include "export/octomap.h"

namespace tessera {
namespace {

constexpr double kMargin_m = 0.5;  // around what was mapped

Status CheckExtension(const char* option, const std::string& path, const char* extension,
                      const char* what) {
    if (path.empty() || std::filesystem::path(path).extension() == extension) return Status::Ok();
    return Status::Error(fmt::format("{} {}: {} is written as {}; use this extension", option, path,
                                     what, extension));
}

// The ROS map and the distance field both have a .yaml. No other two files can have one name.
Status CheckNamesDiffer(const RobotMaps& maps) {
    if (maps.ros_map.empty() || maps.distance.empty()) return Status::Ok();
    const auto whole = [](const std::filesystem::path& path) {
        std::error_code error;
        const std::filesystem::path absolute = std::filesystem::absolute(path, error);
        return (error ? path : absolute).lexically_normal();
    };
    const auto beside = std::filesystem::path(maps.distance).replace_extension(".yaml");
    if (whole(beside) != whole(maps.ros_map)) return Status::Ok();
    return Status::Error(
        fmt::format("--ros-map {} and --distance {}: both write {}; give one of them another name",
                    maps.ros_map, maps.distance, beside.string()));
}

Result<CellGrid> GridOf(const RobotMaps& maps, const BlockMap& map,
                        const Eigen::Isometry3d& T_world_level) {
    Eigen::AlignedBox3d box;
    if (maps.box_m) {
        box = *maps.box_m;
    } else {
        box = BoundsOf(map, T_world_level);
        if (box.isEmpty()) return Status::Error("the scan's map is empty; scan something first");
        box.extend(Eigen::Vector3d(box.min().array() - kMargin_m));
        box.extend(Eigen::Vector3d(box.max().array() + kMargin_m));
    }
    Result<CellGrid> grid = MakeGrid(box, maps.resolution_m, T_world_level);
    if (!grid.ok()) return Status::Error("--box, --resolution: " + grid.message());
    return grid;
}

}  // namespace

Status CheckRobotMaps(const RobotMaps& maps) {
    if (Status s = CheckExtension("--ros-map", maps.ros_map, ".yaml", "a ROS map"); !s.ok())
        return s;
    if (Status s = CheckExtension("--octomap", maps.octomap, ".bt", "an OctoMap"); !s.ok())
        return s;
    if (Status s = CheckExtension("--distance", maps.distance, ".npy", "a distance field"); !s.ok())
        return s;
    if (Status s = CheckNamesDiffer(maps); !s.ok()) return s;
    if (!(maps.heights.low_m >= 0))
        return Status::Error(fmt::format(
            "--heights {:g} {:g}: the first is a height above the floor and must not be negative",
            maps.heights.low_m, maps.heights.high_m));
    if (!(maps.heights.low_m < maps.heights.high_m))
        return Status::Error(fmt::format("--heights {:g} {:g}: the second must be above the first",
                                         maps.heights.low_m, maps.heights.high_m));
    const Eigen::AlignedBox3d any(Eigen::Vector3d::Zero(), Eigen::Vector3d::Ones());
    const Result<CellGrid> grid =
        MakeGrid(maps.box_m.value_or(any), maps.resolution_m, Eigen::Isometry3d::Identity());
    return grid.ok() ? Status::Ok() : Status::Error("--box, --resolution: " + grid.message());
}

Status WriteRobotMaps(const RobotMaps& maps, const BlockMap& map, const PinholeCamera& camera,
                      const std::vector<StampedPose>& path, const Eigen::Isometry3d& T_level_world,
                      const std::string& frame) {
    if (Status status = CheckRobotMaps(maps); !status.ok()) return status;
    const Result<CellGrid> grid = GridOf(maps, map, T_level_world.inverse());
    if (!grid.ok()) return grid.status();
    const Result<Occupancy> occupancy =
        MakeOccupancy(map, grid.value(), camera, path, maps.occupancy);
    if (!occupancy.ok()) return Status::Error("--box, --resolution: " + occupancy.message());
    if (!maps.ros_map.empty())
        if (Status status = WriteRosMap(maps.ros_map, MakeRosMap(occupancy.value(), maps.heights));
            !status.ok())
            return status;
    if (!maps.octomap.empty())
        if (Status status = WriteOctomap(maps.octomap, occupancy.value()); !status.ok())
            return status;
    if (maps.distance.empty()) return Status::Ok();
    const Result<DistanceField> field =
        MakeDistanceField(map, grid.value(), maps.distances, &occupancy.value());
    if (!field.ok()) return Status::Error("--distance " + maps.distance + ": " + field.message());
    return WriteDistanceField(maps.distance, field.value(), frame);
}

}  // namespace tessera
