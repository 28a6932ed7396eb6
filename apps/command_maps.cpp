// tessera maps: maps for robots of a scan file.
#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <numbers>

#include "box_option.h"
#include "command.h"
#include "export/level.h"
#include "export/robot_maps.h"
#include "run/scan_export.h"
#include "run/scanned.h"
#include "scan/scan_content.h"

namespace tessera {
namespace {

struct MapsArguments {
    std::string scan;
    RobotMaps maps;
    std::vector<double> box, heights;
    bool level = false;

    bool NeedsLevel() const { return level || !maps.ros_map.empty(); }
};

// From the mesh, which takes a map of its own.
Result<Level> LevelOf(const std::string& path) {
    const Result<Scanned> scanned = ReadScanFile(path);
    if (!scanned.ok()) return scanned.status();
    Result<Level> level = FindLevel(scanned.value().mesh, scanned.value().path);
    if (!level.ok()) return Status::Error(path + ": " + level.message());
    fmt::print("level: the first camera was tilted by {:.2f} degrees\n",
               level.value().tilt_rad * 180 / std::numbers::pi);
    return level;
}

Status Maps(const MapsArguments& a) {
    RobotMaps maps = a.maps;
    std::error_code ignored;
    if (std::filesystem::is_directory(a.scan, ignored))
        return Status::Error(a.scan +
                             ": is a folder; maps need a scan: run with --scan FILE and give "
                             "that file");
    const auto box = BoxOf(a.box);
    if (!box.ok()) return box.status();
    maps.box_m = box.value();
    if (!a.heights.empty()) {
        maps.heights.low_m = a.heights[0];
        maps.heights.high_m = a.heights[1];
    }
    if (maps.ros_map.empty() && maps.octomap.empty() && maps.distance.empty())
        return Status::Error("no map to make; give --ros-map, --octomap or --distance");
    if (Status status = CheckRobotMaps(maps); !status.ok()) return status;
    Eigen::Isometry3d T_level_world = Eigen::Isometry3d::Identity();
    if (a.NeedsLevel()) {
        const Result<Level> level = LevelOf(a.scan);
        if (!level.ok()) return level.status();
        T_level_world = level.value().T_level_world;
    }
    const Result<ScanContent> scan = ReadScanToShow(a.scan, {});
    if (!scan.ok()) return scan.status();
    // Surfaces that the mesh leaves out count no more here.
    maps.occupancy.min_weight = maps.distances.min_weight =
        ConfigOf(scan.value().meta).meshing.min_weight;
    return WriteRobotMaps(maps, *scan.value().map, scan.value().meta.camera, scan.value().Path(),
                          T_level_world, a.NeedsLevel() ? "level" : "world");
}

}  // namespace

void AddMapsCommand(CLI::App& app, CommandContext& context) {
    auto a = std::make_shared<MapsArguments>();
    CLI::App* command = app.add_subcommand(
        "maps", "Maps for robots of a scan file: 2D map for ROS, OctoMap, distance field");
    command->add_option("SCAN", a->scan, "FILE.scan")->required();
    const auto add = [&](const char* name, auto& value, const char* what, const char* type) {
        return command->add_option(name, value, what)->type_name(type);
    };
    add("--ros-map", a->maps.ros_map,
        "2D map for nav2 and map_server, .yaml with a .pgm beside it; always level", "FILE.yaml");
    add("--octomap", a->maps.octomap, "3D occupancy as an OctoMap tree", "FILE.bt");
    add("--distance", a->maps.distance,
        "Distance to the nearest surface (ESDF), metres, with NAME_known.npy and NAME.yaml beside "
        "it",
        "FILE.npy");
    add("--resolution", a->maps.resolution_m, "Side of a cell of these maps, metres", "M")
        ->capture_default_str();
    AddBoxOption(*command, a->box, "Their box (default: all mapped)");
    command->add_flag("--level", a->level,
                      "z up and the floor at z = 0 for all of them, instead of the first camera's "
                      "axes");
    add("--heights", a->heights,
        "Heights above the floor between which --ros-map shows obstacles, metres (default 0.1 1.8)",
        "M")
        ->expected(2);
    add("--max-distance", a->maps.distances.max_distance_m, "Distances end here, metres", "M")
        ->capture_default_str();
    add("--max-range", a->maps.occupancy.max_range_m,
        "Space this far from a camera is not called free, metres", "M")
        ->capture_default_str();
    add("--views", a->maps.occupancy.most_views,
        "Poses of the path that free space is taken from, at most", "N")
        ->check(CLI::PositiveNumber)
        ->capture_default_str();
    command->callback([a, &context] { context.exit_code = ExitCode(Maps(*a)); });
}

}  // namespace tessera
