// Opens a synthetic source by name.
#include <algorithm>
#include <cctype>
#include <utility>

#include "synth/mesh_scene.h"
#include "synth/model_path.h"
#include "synth/synthetic_source.h"

namespace tessera {
namespace {

bool IsObj(const std::string& name) {
    if (name.size() < 4) return false;
    std::string end = name.substr(name.size() - 4);
    std::transform(end.begin(), end.end(), end.begin(),
                   [](unsigned char c) { return std::tolower(c); });
    return end == ".obj";
}

Result<StagedScene> StageModel(const std::string& path, UpAxis up) {
    Result<ObjModel> model = ReadObj(path);
    if (!model.ok()) return model.status();
    StagedScene staged;
    const std::size_t triangles = model.value().triangles.size();
    auto scene = std::make_unique<MeshScene>(std::move(model.value()));
    staged.path = MakeModelPath(
        *scene, up == UpAxis::kZ ? Eigen::Vector3d::UnitZ() : Eigen::Vector3d::UnitY());
    staged.description =
        fmt::format("model of {} triangles, {} objects", triangles, scene->instances().size() - 1);
    if (!scene->missing_textures().empty())
        staged.description +=
            fmt::format("; {} textures missing, rendered in flat colour (first: {})",
                        scene->missing_textures().size(), scene->missing_textures().front());
    staged.scene = std::move(scene);
    return staged;
}

}  // namespace

Result<std::unique_ptr<SyntheticSource>> OpenSynthetic(const std::string& name,
                                                       const SynthConfig& config) {
    if (Status status = config.Validate(); !status.ok()) return status;
    const std::string prefix = "synthetic:";
    const std::string scene_name = name.starts_with(prefix) ? name.substr(prefix.size()) : name;
    Result<StagedScene> staged =
        IsObj(scene_name) ? StageModel(scene_name, config.model_up) : MakeBuiltinScene(scene_name);
    if (!staged.ok()) return staged.status();
    if (!config.trajectory.empty()) {
        const Eigen::Isometry3d T_world_start = staged.value().path.T_world_camera(0);
        Result<CameraPath> path = ReadCameraPath(
            config.trajectory, config.trajectory_from_start ? &T_world_start : nullptr);
        if (!path.ok()) return path.status();
        staged.value().path = std::move(path.value());
    }
    if (config.speed != 1)
        staged.value().path = SpedUp(std::move(staged.value().path), config.speed);
    return std::make_unique<SyntheticSource>(name, std::move(staged.value()), config);
}

Result<std::unique_ptr<FrameSource>> OpenSyntheticScene(const std::string& name,
                                                        const SynthConfig& config) {
    Result<std::unique_ptr<SyntheticSource>> source = OpenSynthetic(name, config);
    if (!source.ok()) return source.status();
    return std::unique_ptr<FrameSource>(std::move(source.value()));
}

}  // namespace tessera
