#include "export/distance_field.h"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <new>

#include "export/nearest_points.h"
#include "export/npy_writer.h"
#include "export/surface_samples.h"
#include "io/file.h"

namespace tessera {
namespace {

namespace fs = std::filesystem;

DistanceField Make(const BlockMap& map, const CellGrid& grid, const CellGrid& padded,
                   const DistanceField::Options& options, const Occupancy* seen) {
    DistanceField field;
    field.grid = grid;
    field.max_distance_m = options.max_distance_m;
    field.distance_m =
        NearestPoints(SurfacePoints(map, padded, options.min_weight), grid.first - padded.first,
                      grid.size, static_cast<float>(options.max_distance_m / grid.resolution_m));
    field.known.resize(grid.cells());
    const std::vector<std::int8_t> sides = ObservedSides(map, grid);
    const float unit_m = static_cast<float>(grid.resolution_m);
    for (std::size_t i = 0; i < sides.size(); ++i) {
        field.distance_m[i] *= sides[i] < 0 ? -unit_m : unit_m;
        field.known[i] = sides[i] != 0 || (seen != nullptr && seen->cells[i] == CellState::kFree);
    }
    return field;
}

// The first three rows, row by row.
std::string MatrixText(const Eigen::Isometry3d& T) {
    std::string text;
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 4; ++column)
            text += fmt::format("{}{:.9g}", text.empty() ? "" : ", ", T(row, column));
    return text;
}

}  // namespace

Result<DistanceField> MakeDistanceField(const BlockMap& map, const CellGrid& grid,
                                        const DistanceField::Options& options,
                                        const Occupancy* seen) {
    TESSERA_CHECK(seen == nullptr || seen->grid == grid, "the occupancy has another grid");
    if (Status status = CheckResolution(grid, map.config()); !status.ok()) return status;
    if (!(options.max_distance_m > 0 && options.max_distance_m <= 1000))
        return Status::Error(fmt::format("a maximum distance of {:g} m is not within 0 to 1000 m",
                                         options.max_distance_m));
    const Result<CellGrid> padded =
        Padded(grid, static_cast<int>(std::ceil(options.max_distance_m / grid.resolution_m)));
    if (!padded.ok()) return Status::Error(padded.message() + " or a smaller maximum distance");
    try {
        return Make(map, grid, padded.value(), options, seen);
    } catch (const std::bad_alloc&) {
        return Status::Error(
            "the distance field does not fit in memory; take a smaller box, a coarser resolution "
            "or a smaller maximum distance");
    }
}

Status WriteDistanceField(const std::string& path, const DistanceField& field,
                          const std::string& frame) {
    const Eigen::Vector3i& n = field.grid.size;
    const fs::path known_path = fs::path(path).replace_filename(
        fs::path(path).stem().string() + "_known" + fs::path(path).extension().string());
    if (Status status = WriteNpy(path, field.distance_m, n.z(), n.y(), n.x()); !status.ok())
        return status;
    if (Status status = WriteNpy(known_path.string(), field.known, n.z(), n.y(), n.x());
        !status.ok())
        return status;
    const Eigen::Vector3d origin = field.grid.Centre(0, 0, 0);
    return WriteTextFile(
        fs::path(path).replace_extension(".yaml").string(),
        fmt::format("# Distance to the nearest surface in metres, negative behind it. Cell\n"
                    "# [k, j, i] has its centre at origin + resolution * (i, j, k).\n"
                    "distance: {}\n"
                    "known: {}\n"
                    "shape: [{}, {}, {}]  # z, y, x\n"
                    "resolution: {:.9g}\n"
                    "origin: [{:.9g}, {:.9g}, {:.9g}]\n"
                    "max_distance: {:.9g}\n"
                    "frame: {}\n"
                    "T_world_frame: [{}]  # 3 x 4, row by row; world: that of the scan\n",
                    fs::path(path).filename().string(), known_path.filename().string(), n.z(),
                    n.y(), n.x(), field.grid.resolution_m, origin.x(), origin.y(), origin.z(),
                    field.max_distance_m, frame, MatrixText(field.grid.T_world_grid)));
}

}  // namespace tessera
