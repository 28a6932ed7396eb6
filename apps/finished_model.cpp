#include "finished_model.h"

#include <fmt/format.h>

#include <filesystem>
#include <string>
#include <system_error>
#include <vector>

#include "export/level.h"
#include "io/file.h"
#include "io/image_io.h"
#include "io/mesh_io.h"
#include "io/mesh_writers.h"
#include "render/mesh_picture.h"

namespace tessera {

Status WriteFinishedModel(const std::string& out, const FinishedModel& finished, bool level) {
    const auto upright = [&](const TexturedMesh& model) {
        TexturedMesh turned = model;
        if (level) turned.mesh = WithYDown(std::move(turned.mesh));
        return turned;
    };
    const TexturedMesh& model = finished.model;
    const MeshView view = ChooseView(model.mesh);
    for (Status status : {WriteTexturedGlb(out + "/model.glb", upright(model)),
                          WriteTexturedObj(out + "/model.obj", model),
                          WriteColourImage(out + "/preview.png",
                                           RenderTextured(model, view.camera, view.T_world_camera)),
                          WriteTextFile(out + "/finish.json", FinishReportJson(finished.report)),
                          WritePly(out + "/filled.ply", finished.filled)})
        if (!status.ok()) return status;
    for (std::size_t i = 0; i < finished.lower_levels.size(); ++i) {
        Status status = WriteTexturedGlb(fmt::format("{}/model_lod{}.glb", out, i + 1),
                                         upright(finished.lower_levels[i]));
        if (!status.ok()) return status;
    }
    // What another model left here.
    std::vector<std::string> others{out + "/watertight.obj"};
    for (std::size_t i = finished.lower_levels.size() + 1; i <= kMostLowerLevels; ++i)
        others.push_back(fmt::format("{}/model_lod{}.glb", out, i));
    for (const std::string& other : others)
        if (std::error_code error; !std::filesystem::remove(other, error) && error)
            return Status::Error(fmt::format("{}: is of another model and cannot be removed: {}",
                                             other, error.message()));
    return Status::Ok();
}

}  // namespace tessera
