#include "run/earlier_run.h"

#include <fmt/format.h>

#include <filesystem>
#include <vector>

#include "io/trajectory.h"
#include "report/run_record.h"
#include "run/open_source.h"

namespace tessera {

namespace fs = std::filesystem;

namespace {

// A run writes it first, and removes it last.
bool HoldsRun(const std::string& folder) {
    std::error_code ignored;
    return fs::exists(folder + "/run.json", ignored);
}

// Names of the files in `folder` that a run into it writes anew, or leaves out, but for run.json.
std::vector<std::string> ResultsIn(const std::string& folder) {
    std::vector<std::string> files;
    std::error_code ignored;
    const auto add = [&](const std::string& name) {
        const bool exists = fs::exists(folder + "/" + name, ignored);
        if (exists) files.push_back(name);
        return exists;
    };
    for (const char* name :
         {"mesh.ply", "preview.png", "objects.json", "timings.json", "detections.txt",
          "trajectory.txt", "frames.csv", "trajectory_tracked.txt"})
        add(name);
    for (int clock = 1; add(NumberedPath("trajectory.txt", clock));) ++clock;
    return files;
}

}  // namespace

Status CheckOutputFolder(const std::string& source, const std::string& folder) {
    std::error_code ignored;
    if (fs::is_directory(source, ignored) && fs::equivalent(source, folder, ignored))
        return Status::Error(
            fmt::format("{}: is the folder of the recording itself, whose files a run must not "
                        "replace; give another one with --out",
                        folder));
    if (HoldsRun(folder)) return Status::Ok();
    if (const std::vector<std::string> files = ResultsIn(folder); !files.empty())
        return Status::Error(
            fmt::format("{}/{}: would be replaced, but is not of a run (there is no run.json "
                        "beside it); move it away, or give another folder with --out",
                        folder, files.front()));
    return Status::Ok();
}

void RemoveEarlierRun(const std::string& folder) {
    if (!HoldsRun(folder)) return;
    std::error_code ignored;
    for (const std::string& name : ResultsIn(folder)) fs::remove(folder + "/" + name, ignored);
}

bool HoldsCameraRun(const std::string& folder) {
    const Result<RunRecord> run = ReadRunRecord(folder + "/run.json");
    if (!run.ok() || !IsLiveSource(run.value().source_name)) return false;
    return ReadTrajectory(folder + "/trajectory.txt").ok();  // not without a pose, for one
}

Result<std::string> KeepEarlierRun(const std::string& folder, const std::string& resumed_scan) {
    if (!HoldsCameraRun(folder)) return std::string();
    const Result<RunRecord> run = ReadRunRecord(folder + "/run.json");
    if (run.ok() && !resumed_scan.empty() && run.value().scan == resumed_scan) return std::string();
    std::error_code error;
    std::string kept;
    for (int number = 1; kept.empty(); ++number) {
        const std::string free = fmt::format("{}/earlier_{}", folder, number);
        if (fs::create_directory(free, error)) kept = free;
        if (error) return Status::Error(fmt::format("{}: {}", free, error.message()));
    }
    std::vector<std::string> files = ResultsIn(folder);
    files.push_back("run.json");
    if (fs::exists(folder + "/measurements.json", error)) files.push_back("measurements.json");
    for (const std::string& name : files) {
        const std::string from = folder + "/" + name;
        fs::rename(from, kept + "/" + name, error);
        if (error) return Status::Error(fmt::format("{}: {}", from, error.message()));
    }
    return kept;
}

}  // namespace tessera
