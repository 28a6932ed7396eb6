#include "run/memory_watch.h"

#include <fmt/format.h>

#include "core/memory.h"
#include "mapping/map_estimate.h"

namespace tessera {
namespace {

constexpr double kMb = 1 << 20, kInterval_ms = 250;
// Walls, floor, ceiling and furniture of a room of 4 x 5 m.
constexpr double kRoom_m2 = 150;
// What the end of a run takes beside the map, in sizes of the map: the mesh, a checkpoint, and with
// loop closure a corrected map. A little more than the integrator leaves, which would refuse
// blocks.
constexpr double kReserve_mb = 160, kEndPerMap = 2.2, kCorrectedPerMap = 1.2;

double EndPerMap(bool loops) { return kEndPerMap + (loops ? kCorrectedPerMap : 0); }

constexpr const char* kCure =
    "larger voxels (mapping.voxel_size_m) need less, and so does mapping.memory_limit_mb with "
    "--scan";

}  // namespace

std::string MemoryWarning(const RunConfig& config) {
    if (config.pipeline.has_memory_limit()) return "";
    const BlockMap::Config& map = config.pipeline.map;
    const double mb_per_m2 = MapBytesPerSquareMetre(map.voxel_size_m, map.truncation_m) / kMb;
    const double free_mb = FreeMemoryMb();
    const double lasts_m2 = free_mb / (mb_per_m2 * (1 + EndPerMap(config.loops.enabled)));
    if (lasts_m2 >= kRoom_m2) return "";
    return fmt::format(
        "voxels of {:g} mm take about {:.0f} MB of memory for a square metre of surface, and more "
        "for mesh and corrections: the {:.1f} GB that are free last for about {:.0f} m2 "
        "(a furnished room has {:.0f}); {}",
        1000 * map.voxel_size_m, mb_per_m2, free_mb / 1024, lasts_m2, kRoom_m2, kCure);
}

std::optional<std::string> MemoryWatch::Check(const MapStatistics& map, bool refused) {
    if (told_ || (!refused && since_check_.ElapsedMs() < kInterval_ms)) return std::nullopt;
    since_check_ = Stopwatch();
    const double needed_mb = kReserve_mb + EndPerMap(loops_) * static_cast<double>(map.bytes) / kMb;
    const double free_mb = FreeMemoryMb();
    if (!refused && free_mb > needed_mb) return std::nullopt;
    told_ = true;
    return fmt::format(
        "memory is nearly used up: {:.0f} MB are free, and the end of the run may need as much; "
        "the run ends here, and everything is written; {}",
        free_mb, kCure);
}

}  // namespace tessera
