#include "system/run.h"

#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include "system/runner.h"

namespace tessera {

MapStatistics StatisticsOf(const BlockMap& map) {
    return {map.count(), map.bytes(), map.bytes_per_voxel()};
}

Result<RunSummary> ExecuteRun(const RunRequest& request, const RunConfig& config, const RunObserver& observer,
                              const std::atomic<bool>& stop) {
    Runner runner(request, config, observer);
    if (config.threads == 0) return runner.Run(stop);
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                                    static_cast<std::size_t>(config.threads));
    return tbb::task_arena(config.threads).execute([&] { return runner.Run(stop); });
}

}  // namespace tessera
