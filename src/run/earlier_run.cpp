#include "run/earlier_run.h"

#include <fmt/format.h>

#include <filesystem>
#include <vector>

#include "io/trajectory.h"
#include "report/run_record.h"
#include "run/open_source.h"

namespace tessera {

namespace fs = std::filesystem;

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

bool HoldsCameraRun(const std::string& folder) {
    const Result<RunRecord> run = ReadRunRecord(folder + "/run.json");
    if (!run.ok() || !IsLiveSource(run.value().source_name)) return false;
    return ReadTrajectory(folder + "/trajectory.txt").ok();  // not without a pose, for one
}

Result<std::string> KeepEarlierRun(const std::string& folder) {
    if (!HoldsCameraRun(folder)) return std::string();
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
