// tessera objects: writes each object of a labelled mesh as its own mesh.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>

#include "command.h"
#include "io/file.h"
#include "io/mesh_io.h"
#include "semantics/objects_file.h"

namespace tessera {
namespace {

struct Folders {
    std::string run, out;
};

Status WriteObjects(const Folders& folders) {
    const Result<std::vector<MapObject>> objects = ReadObjects(folders.run + "/objects.json");
    if (!objects.ok()) return objects.status();
    const Result<TriangleMesh> mesh = ReadPly(folders.run + "/mesh.ply");
    if (!mesh.ok()) return mesh.status();
    if (mesh.value().labels.empty())
        return Status::Error(folders.run +
                             "/mesh.ply: has no labels; repeat the run with --labels");
    if (Status status = PrepareOutputFolder(folders.out); !status.ok()) return status;
    for (const MapObject& o : objects.value()) {
        std::string name = o.class_name;
        std::ranges::replace(name, '/', '_');
        const std::string path = fmt::format("{}/{:03}-{}.ply", folders.out, o.id, name);
        const TriangleMesh part = ExtractInstance(mesh.value(), o.id);
        if (Status status = WritePly(path, part); !status.ok()) return status;
        fmt::print("{}  {} triangles\n", path, part.triangles.size());
    }
    return Status::Ok();
}

}  // namespace

void AddObjectsCommand(CLI::App& app, CommandContext& context) {
    auto folders = std::make_shared<Folders>();
    CLI::App* command =
        app.add_subcommand("objects", "Write each labelled object of a run as a separate mesh");
    command->add_option("RUN_DIR", folders->run, "Folder of a run with --labels")->required();
    command->add_option("--out", folders->out, "Folder for NUMBER-CLASS.ply")
        ->required()
        ->type_name("DIR");
    command->callback(
        [folders, &context] { context.exit_code = ExitCode(WriteObjects(*folders)); });
}

}  // namespace tessera
