#include "synth/builtin_scenes.h"

#include <fmt/format.h>

#include <array>
#include <utility>

namespace tessera {
namespace {

constexpr std::array<std::pair<const char*, StagedScene (*)()>, 11> kScenes = {{
    {"desk", MakeDesk},
    {"room", MakeRoom},
    {"flat", MakeFlat},
    {"walk", MakeWalk},
    {"corridor", MakeCorridor},
    {"floor", MakeFloor},
    {"corner", MakeCorner},
    {"wall", MakeWall},
    {"people", MakePeople},
    {"chair", MakeChair},
    {"door", MakeDoor},
}};

}  // namespace

std::vector<std::string> BuiltinSceneNames() {
    std::vector<std::string> names;
    for (const auto& [name, make] : kScenes) names.emplace_back(name);
    return names;
}

Result<StagedScene> MakeBuiltinScene(const std::string& name) {
    for (const auto& [known, make] : kScenes)
        if (name == known) return make();
    return Status::Error(
        fmt::format("'{}' is not a built-in scene; use one of {}, or give an .obj file", name,
                    fmt::join(BuiltinSceneNames(), ", ")));
}

}  // namespace tessera
