// tessera render: a picture of a mesh, without a window or OpenGL.
#include <CLI/CLI.hpp>
#include <memory>

#include "command.h"
#include "io/image_io.h"
#include "io/mesh_io.h"
#include "io/trajectory.h"
#include "render/mesh_picture.h"
#include "system/scan_export.h"

namespace tessera {
namespace {

using Shading = RenderStyle::Shading;

struct Arguments {
    std::string mesh, out, trajectory;
    int width = 1280, height = 960;
    Shading shading = Shading::kColour;
};

Status Render(const Arguments& a) {
    const Result<TriangleMesh> mesh = a.mesh.ends_with(".scan") ? MeshOfScanFile(a.mesh, nullptr) : ReadPly(a.mesh);
    if (!mesh.ok()) return mesh.status();
    if (mesh.value().triangles.empty()) return Status::Error(a.mesh + ": has no triangles");
    RenderStyle style;
    style.shading = a.shading;
    if (!a.trajectory.empty()) {
        const Result<Trajectory> trajectory = ReadTrajectory(a.trajectory);
        if (!trajectory.ok()) return trajectory.status();
        for (const StampedPose& pose : trajectory.value().poses) style.path.push_back(pose.T_world_camera);
    }
    const MeshView view = ChooseView(mesh.value(), style.path, a.width, a.height);
    return WriteColourImage(a.out, RenderMesh(mesh.value(), view.camera, view.T_world_camera, style));
}

}  // namespace

void AddRenderCommand(CLI::App& app, CommandContext& context) {
    auto a = std::make_shared<Arguments>();
    CLI::App* command = app.add_subcommand("render", "Draw a mesh; the view is chosen so that all of it shows");
    command->add_option("MESH", a->mesh, "PLY file, or FILE.scan")->required();
    command->add_option("--out", a->out, "Picture to write, .png or .jpg")->required()->type_name("PICTURE.png");
    command->add_option("--trajectory", a->trajectory, "Draw this path too, and look from behind its cameras")
        ->type_name("FILE");
    command->add_option("--width", a->width, "Pixels")->check(CLI::Range(16, 8192))->capture_default_str();
    command->add_option("--height", a->height, "Pixels")->check(CLI::Range(16, 8192))->capture_default_str();
    command->add_option("--shading", a->shading, "colour as it is, colour lit, grey lit, or normals (default colour)")
        ->transform(CLI::CheckedTransformer(std::map<std::string, Shading>{{"colour", Shading::kColour},
                                                                           {"lit", Shading::kLitColour},
                                                                           {"grey", Shading::kShaded},
                                                                           {"normal", Shading::kNormal}}));
    command->callback([a, &context] { context.exit_code = ExitCode(Render(*a)); });
}

}  // namespace tessera
