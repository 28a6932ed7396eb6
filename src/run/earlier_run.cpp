#include "run/earlier_run.h"

#include <fmt/format.h>

#include <filesystem>
#include <vector>

#include "io/trajectory.h"
#include "report/run_record.h"
#include "run/open_source.h"

namespace tessera {
namespace {

namespace fs = std::filesystem;

// Those of the run, and what people made of them in the window.
std::vector<std::string> FilesOfRun(const std::string& folder) {
    std::vector<std::string> files = {
        "mesh.ply",       "preview.png",      "objects.json",   "timings.json",
        "detections.txt", "frames.csv",       "trajectory.txt", "trajectory_tracked.txt",
        "run.json",       "measurements.json"};
    std::error_code ignored;
    for (int clock = 1;; ++clock) {
        const std::string name = NumberedPath("trajectory.txt", clock);
        if (!fs::exists(folder + "/" + name, ignored)) return files;
        files.push_back(name);
    }
}

}  // namespace

Result<std::string> KeepEarlierRun(const std::string& folder) {
    const Result<RunRecord> run = ReadRunRecord(folder + "/run.json");
    if (!run.ok() || !IsLiveSource(run.value().source_name)) return std::string();
    const Result<Trajectory> path = ReadTrajectory(folder + "/trajectory.txt");
    if (!path.ok()) return std::string();  // no pose in it, for one
    std::error_code error;
    std::string kept;
    for (int number = 1; kept.empty(); ++number) {
        const std::string free = fmt::format("{}/earlier_{}", folder, number);
        if (fs::create_directory(free, error)) kept = free;
        if (error) return Status::Error(fmt::format("{}: {}", free, error.message()));
    }
    for (const std::string& name : FilesOfRun(folder)) {
        const std::string from = folder + "/" + name;
        if (!fs::exists(from, error)) continue;
        fs::rename(from, kept + "/" + name, error);
        if (error) return Status::Error(fmt::format("{}: {}", from, error.message()));
    }
    return kept;
}

}  // namespace tessera
