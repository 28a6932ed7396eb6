#include "eval/label_run.h"

#include <nlohmann/json.hpp>
#include <sstream>

#include "eval/alignment.h"
#include "eval/mesh_error.h"
#include "io/file.h"
#include "io/mesh_io.h"
#include "io/trajectory.h"

namespace tessera {
namespace {

Status ReadObjects(const std::string& path, RunLabels& run) {
    const Result<std::string> text = ReadWholeFile(path, std::size_t{1} << 28);
    if (!text.ok()) return text.status();
    const auto json = nlohmann::json::parse(text.value(), nullptr, false);
    if (!json.is_array()) return Status::Error(path + ": is not a list of objects");
    for (const auto& object : json) {
        if (!object.is_object() || !object.contains("class_id") ||
            !object["class_id"].is_number_integer() || !object.contains("class") ||
            !object["class"].is_string())
            return Status::Error(path + ": an object has no class");
        run.class_names[object["class_id"].get<int>()] = object["class"].get<std::string>();
    }
    return Status::Ok();
}

Status ReadDetections(const std::string& path, RunLabels& run) {
    const Result<std::string> text = ReadWholeFile(path, std::size_t{1} << 30);
    if (!text.ok()) return Status::Error(text.message() + "; was the run made with --labels?");
    std::istringstream lines(text.value());
    double frame = 0;
    for (std::string line; std::getline(lines, line);) {
        std::istringstream words(line);
        if (line.starts_with("# frame ")) {
            words.ignore(8);
            if (words >> frame) run.frames[frame];
            continue;
        }
        RunDetection d;
        double stamp_s = 0;
        if (line.starts_with('#') || !(words >> stamp_s >> d.name >> d.probability >> d.x_min >>
                                       d.y_min >> d.x_max >> d.y_max))
            continue;
        run.frames[stamp_s].push_back(d);
        run.wanted.insert(d.name);
    }
    return run.frames.empty() ? Status::Error(path + ": contains no frames") : Status::Ok();
}

}  // namespace

Result<RunLabels> ReadLabelRun(const std::string& folder, const LabelTruth& truth) {
    RunLabels run;
    if (Status status = ReadObjects(folder + "/objects.json", run); !status.ok()) return status;
    if (Status status = ReadDetections(folder + "/detections.txt", run); !status.ok())
        return status;
    Result<TriangleMesh> mesh = ReadPly(folder + "/mesh.ply");
    if (!mesh.ok()) return mesh.status();
    if (mesh.value().labels.empty())
        return Status::Error(folder + "/mesh.ply: has no labels; repeat the run with --labels");
    const Result<Trajectory> path = ReadTrajectory(folder + "/trajectory.txt");
    if (!path.ok()) return path.status();
    const Result<Alignment> alignment = AlignTrajectories(truth.poses, path.value().poses);
    if (!alignment.ok()) return Status::Error(folder + "/trajectory.txt: " + alignment.message());
    run.mesh = TransformMesh(mesh.value(), alignment.value().T_reference_estimate);
    run.mesh.labels = std::move(mesh.value().labels);
    return run;
}

}  // namespace tessera
