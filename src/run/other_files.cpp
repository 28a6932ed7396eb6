#include "run/other_files.h"

#include <fmt/format.h>

#include <array>
#include <filesystem>

#include "core/camera.h"
#include "core/printable.h"
#include "io/trajectory.h"
#include "recordings/endings.h"

namespace tessera {
namespace {

namespace fs = std::filesystem;

// "{}" stands for the path, quoted for a shell.
struct Kind {
    const char* ending;
    const char* what;
};

constexpr std::array kKinds{
    Kind{".ply", "a mesh; tessera view {} shows it"},
    Kind{".obj",
         "a mesh; tessera run synthetic:{} scans it, tessera render {} --out P.png shows it"},
    Kind{".glb", "a model; Blender and f3d open it"},
    Kind{".onnx", "a detection network; tessera run SOURCE --labels {} uses it"},
    Kind{".weights", "the weights of a detection network; give its .cfg file to --labels"},
    Kind{".zip", "an archive; unpack it and give the folder"},
    Kind{".mp4", "a video without depth; give the folder that holds it (Stray Scanner: rgb.mp4)"},
    Kind{".png", "an image; a source is the folder of a whole recording"},
    Kind{".jpg", "an image; a source is the folder of a whole recording"}};

std::string DescribeText(const std::string& path, const std::string& ending) {
    if (ending == ".yaml" || ending == ".yml")
        return ReadCameraFile(path).ok()
                   ? "a camera file; it belongs beside the folders depth and rgb of a recording"
                   : fmt::format("a configuration; tessera run SOURCE --config {} uses it",
                                 ShellLine({path}));
    if (ending != ".txt") return "";
    const Result<Trajectory> path_file = ReadTrajectory(path);
    return path_file.ok() ? fmt::format("a path of {} poses; tessera eval ate TRUTH {} measures it",
                                        path_file.value().poses.size(), ShellLine({path}))
                          : "";
}

}  // namespace

std::string DescribeOtherFile(const std::string& path) {
    std::error_code ignored;
    if (fs::is_directory(path, ignored))
        return fs::exists(fs::path(path) / "run.json", ignored) &&
                       !fs::exists(fs::path(path) / "rgb.txt", ignored)
                   ? fmt::format("the results of a run; tessera view {} shows them",
                                 ShellLine({path}))
                   : "";
    if (!fs::is_regular_file(path, ignored)) return "";
    const std::string ending = EndingOf(path);
    for (const Kind& kind : kKinds) {
        if (ending != kind.ending) continue;
        std::string text = kind.what;
        const std::string word = ShellLine({path});
        for (std::size_t at = 0; (at = text.find("{}", at)) != std::string::npos; at += word.size())
            text.replace(at, 2, word);
        return text;
    }
    return DescribeText(path, ending);
}

}  // namespace tessera
