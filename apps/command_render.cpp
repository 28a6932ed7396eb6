// tessera render: renders a picture of a mesh, without a window or OpenGL.
#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>

#include "command.h"
#include "io/image_io.h"
#include "io/trajectory.h"
#include "render/mesh_picture.h"
#include "run/scanned.h"
#include "semantics/objects_file.h"

namespace tessera {
namespace {

enum class Shading { kColour, kLit, kGrey, kNormal, kLabel };

struct RenderArguments {
    std::string mesh, out, trajectory, objects;
    int width = 1280, height = 960;
    std::int64_t pose = -1;
    Shading shading = Shading::kColour;
};

RenderStyle::Shading ToStyle(Shading shading) {
    switch (shading) {
        case Shading::kColour: return RenderStyle::Shading::kColour;
        case Shading::kLit:
        case Shading::kLabel: return RenderStyle::Shading::kLitColour;
        case Shading::kGrey: return RenderStyle::Shading::kShaded;
        case Shading::kNormal: return RenderStyle::Shading::kNormal;
    }
    return RenderStyle::Shading::kColour;
}

NamedBox ToBox(const MapObject& o) {
    return {o.T_world_oriented, o.oriented_size,
            fmt::format("{} {} {:.0f}%", o.class_name, o.id, 100 * o.probability), o.colour};
}

// Applies category colours, and the boxes and names from the given objects.json. With category
// colours, the default is the objects.json beside the mesh.
Status ApplyLabels(const RenderArguments& a, TriangleMesh& mesh, RenderStyle& style) {
    const bool by_label = a.shading == Shading::kLabel;
    if (by_label && mesh.labels.empty())
        return Status::Error(a.mesh + ": has no labels; repeat the run with --labels");
    std::string path = a.objects;
    const std::string beside =
        (std::filesystem::path(a.mesh).parent_path() / "objects.json").string();
    std::error_code ignored;
    if (path.empty() && by_label && std::filesystem::exists(beside, ignored)) path = beside;
    std::vector<MapObject> objects;
    if (!path.empty()) {
        Result<std::vector<MapObject>> read = ReadObjects(path);
        if (!read.ok()) return read.status();
        objects = std::move(read.value());
    }
    for (const MapObject& object : objects) style.boxes.push_back(ToBox(object));
    if (by_label) mesh.colours = CategoryColours(mesh, objects);
    return Status::Ok();
}

// A view from a camera pose, 70 degrees wide.
MeshView ViewOfPose(const RenderArguments& a, const Eigen::Isometry3d& T_world_camera) {
    MeshView view;
    view.T_world_camera = T_world_camera;
    view.camera.width = a.width, view.camera.height = a.height;
    view.camera.fx = view.camera.fy = 0.714 * a.width;
    view.camera.cx = (a.width - 1) / 2.0, view.camera.cy = (a.height - 1) / 2.0;
    return view;
}

Status Render(const RenderArguments& a) {
    Result<Scanned> scanned = ReadScanOrMesh(a.mesh);
    if (!scanned.ok()) return scanned.status();
    TriangleMesh& mesh = scanned.value().mesh;
    if (mesh.triangles.empty()) return Status::Error(a.mesh + ": has no triangles");
    RenderStyle style;
    style.shading = ToStyle(a.shading);
    if (Status status = ApplyLabels(a, mesh, style); !status.ok()) return status;
    if (!a.trajectory.empty()) {
        const Result<Trajectory> trajectory = ReadTrajectory(a.trajectory);
        if (!trajectory.ok()) return trajectory.status();
        for (const StampedPose& pose : trajectory.value().poses)
            style.path.push_back(pose.T_world_camera);
    }
    if (a.pose >= static_cast<std::int64_t>(style.path.size()))
        return Status::Error(
            fmt::format("--pose {}: --trajectory has {} poses", a.pose, style.path.size()));
    MeshView view;
    if (a.pose >= 0) {
        view = ViewOfPose(a, style.path[static_cast<std::size_t>(a.pose)]);
        style.path.clear();  // the path would start at the eye point
    } else {
        view = ChooseView(mesh, style.path, a.width, a.height);
    }
    return WriteColourImage(a.out, RenderMesh(mesh, view.camera, view.T_world_camera, style));
}

}  // namespace

void AddRenderCommand(CLI::App& app, CommandContext& context) {
    auto a = std::make_shared<RenderArguments>();
    CLI::App* command =
        app.add_subcommand("render", "Render a mesh; the view is chosen to show all of it");
    command->add_option("MESH", a->mesh, "PLY file, or FILE.scan")->required();
    command->add_option("--out", a->out, "Picture to write, .png or .jpg")
        ->required()
        ->type_name("PICTURE.png");
    command
        ->add_option("--trajectory", a->trajectory,
                     "Draw this path too, and choose a view from behind its cameras")
        ->type_name("FILE");
    command->add_option("--width", a->width, "Pixels")
        ->check(CLI::Range(16, 8192))
        ->capture_default_str();
    command->add_option("--height", a->height, "Pixels")
        ->check(CLI::Range(16, 8192))
        ->capture_default_str();
    command
        ->add_option("--shading", a->shading,
                     "colour: vertex colours; lit: vertex colours with shading; grey: shaded "
                     "without colour; normal: normals; label: by category, with the objects' boxes "
                     "and names (default colour)")
        ->transform(
            CLI::CheckedTransformer(std::map<std::string, Shading>{{"colour", Shading::kColour},
                                                                   {"lit", Shading::kLit},
                                                                   {"grey", Shading::kGrey},
                                                                   {"normal", Shading::kNormal},
                                                                   {"label", Shading::kLabel}}));
    command
        ->add_option("--objects", a->objects,
                     "Draw the boxes and names in this objects.json (with --shading label, "
                     "default: the one beside the mesh)")
        ->type_name("FILE");
    command
        ->add_option("--pose", a->pose,
                     "View from the trajectory pose with this number, counted from 0")
        ->check(CLI::NonNegativeNumber);
    command->callback([a, &context] { context.exit_code = ExitCode(Render(*a)); });
}

}  // namespace tessera
