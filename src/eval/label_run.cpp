#include "eval/label_run.h"

#include <nlohmann/json.hpp>

#include "core/input_file.h"
#include "eval/alignment.h"
#include "eval/detection_run.h"
#include "eval/mesh_error.h"
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

}  // namespace

Result<RunLabels> ReadLabelRun(const std::string& folder, LabelTruth& truth) {
    RunLabels run;
    if (Status status = ReadObjects(folder + "/objects.json", run); !status.ok()) return status;
    const Result<Detections> detections = ReadDetections(folder, {});
    if (!detections.ok()) return detections.status();
    Rename(detections.value().aliases, truth);
    Result<std::vector<ScoredImage>> images = PairWithTruth(truth, detections.value().rows, folder);
    if (!images.ok()) return images.status();
    run.images = std::move(images.value());
    run.wanted = detections.value().looked_for;
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
