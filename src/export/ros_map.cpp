#include "export/ros_map.h"

#include <fmt/format.h>

#include <filesystem>
#include <string_view>

#include "io/file.h"

namespace tessera {
namespace {

std::uint8_t ColumnOf(const Occupancy& occupancy, const RosMap::Options& options, int x, int y) {
    constexpr double kSlack_m = 1e-6;  // sides of cells are rounded
    const double half_m = occupancy.grid.resolution_m / 2;
    bool is_free = false;
    for (int z = 0; z < occupancy.grid.size.z(); ++z) {
        const double height_m = occupancy.grid.Centre(x, y, z).z();
        const CellState state = occupancy.At(x, y, z);
        if (height_m + half_m <= kSlack_m - options.low_m || height_m >= options.high_m ||
            state == CellState::kUnknown)
            continue;
        const bool above_floor = height_m - half_m >= options.low_m - kSlack_m;
        if (above_floor && state == CellState::kOccupied) return RosMap::kOccupied;
        is_free = true;
    }
    return is_free ? RosMap::kFree : RosMap::kUnknown;
}

}  // namespace

RosMap MakeRosMap(const Occupancy& occupancy, const RosMap::Options& options) {
    TESSERA_CHECK(options.low_m >= 0 && options.low_m < options.high_m, "heights {} to {}",
                  options.low_m, options.high_m);
    const CellGrid& grid = occupancy.grid;
    RosMap map{Image<std::uint8_t>(grid.size.x(), grid.size.y()), grid.resolution_m, grid.Low().x(),
               grid.Low().y()};
    for (int y = 0; y < grid.size.y(); ++y)
        for (int x = 0; x < grid.size.x(); ++x)
            map.pixels(x, grid.size.y() - 1 - y) = ColumnOf(occupancy, options, x, y);
    return map;
}

Status WriteRosMap(const std::string& yaml_path, const RosMap& map) {
    const auto image_path = std::filesystem::path(yaml_path).replace_extension(".pgm");
    AtomicFile image(image_path.string());
    image.Write(fmt::format("P5\n{} {}\n255\n", map.pixels.width(), map.pixels.height()));
    image.Write({reinterpret_cast<const char*>(map.pixels.data()), map.pixels.size()});
    if (Status status = image.Commit(); !status.ok()) return status;
    // With nav2's own default for free_thresh, 0.25, pixels of 205 would be free.
    return WriteTextFile(yaml_path, fmt::format("image: {}\n"
                                                "mode: trinary\n"
                                                "resolution: {:.9g}\n"
                                                "origin: [{:.9g}, {:.9g}, 0]\n"
                                                "negate: 0\n"
                                                "occupied_thresh: 0.65\n"
                                                "free_thresh: 0.196\n",
                                                image_path.filename().string(), map.resolution_m,
                                                map.origin_x_m, map.origin_y_m));
}

}  // namespace tessera
