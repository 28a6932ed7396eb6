#include "run/run.h"

#include <fmt/format.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include "core/memory.h"
#include "optimize/pose_graph.h"
#include "run/runner.h"

namespace tessera {
namespace {

Status CheckLoops(const RunRequest& request, const RunConfig& config) {
    const bool refine = config.loops.refine_calibration;
    if (refine && !config.loops.enabled)
        return Status::Error("calibration.refine: needs --loop-closure on");
    if (refine && !request.scan_file.empty())
        return Status::Error(
            "calibration.refine: not possible with --scan or --resume, whose frames share one "
            "calibration; first find the calibration in a run without them, then scan with it");
    if (!config.loops.enabled) return Status::Ok();
    if (!PoseGraphAvailable())
        return Status::Error(
            "--loop-closure on: this build has no pose graph; install libceres-dev and build "
            "again");
    return Status::Ok();
}

Status CheckScan(const RunRequest& request) {
    const bool given = !request.poses_file.empty();
    if (given && (request.resume || request.localise_only))
        return Status::Error(fmt::format(
            "{}: not possible with --poses, which already gives the poses; leave one of the two "
            "out",
            request.resume ? "--resume" : "--localise-only"));
    if (request.localise_only && !request.labels.empty())
        return Status::Error(
            "--localise-only: changes nothing in the map, so it cannot label objects; leave "
            "--labels out");
    return Status::Ok();
}

Status CheckPaging(const RunRequest& request, const RunConfig& config) {
    if (!config.pipeline.has_memory_limit()) return Status::Ok();
    const std::string key = "mapping.memory_limit_mb: ";
    if (request.scan_file.empty())
        return Status::Error(
            key + "blocks that leave memory are moved to the scan file; give --scan FILE");
    if (request.localise_only)
        return Status::Error(key +
                             "not possible with --localise-only, which only reads the scan; leave "
                             "one of the two out");
    return Status::Ok();
}

Status CheckDevice(const RunRequest& request, const RunConfig& config) {
    if (request.device == nullptr) return Status::Ok();
    if (config.pipeline.has_memory_limit())
        return Status::Error(
            "--device cuda: not supported yet with mapping.memory_limit_mb; leave one of the two "
            "out");
    return Status::Ok();
}

}  // namespace

Status CheckRun(const RunRequest& request, const RunConfig& config) {
    for (const Status& status : {config.Validate(), CheckLoops(request, config), CheckScan(request),
                                 CheckPaging(request, config), CheckDevice(request, config)})
        if (!status.ok()) return status;
    return Status::Ok();
}

Result<RunSummary> ExecuteRun(const RunRequest& request, const RunConfig& config,
                              const RunObserver& observer, const std::atomic<bool>& stop) {
    RunConfig effective = config;
    if (!request.poses_file.empty())
        effective.loops.enabled = false;  // there is nothing to correct
    Runner runner(request, effective, observer);
    SetMemoryLimit(config.memory_limit_mb);
    if (config.threads == 0) return runner.Run(stop);
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                                    static_cast<std::size_t>(config.threads));
    return tbb::task_arena(config.threads).execute([&] { return runner.Run(stop); });
}

}  // namespace tessera
