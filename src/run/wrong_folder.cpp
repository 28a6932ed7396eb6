#include "run/wrong_folder.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <vector>

#include "recordings/endings.h"
#include "recordings/open_recording.h"

namespace tessera {
namespace {

namespace fs = std::filesystem;

// As IsStrayFolder and IsPolycamFolder. Folders end with a slash.
struct AppFolder {
    const char* kind;
    std::vector<const char*> signs;  // any of them tells the app
    std::vector<const char*> parts;  // all are needed
};

const std::array<AppFolder, 2>& AppFolders() {
    static const std::array<AppFolder, 2> kFolders{
        AppFolder{"a Stray Scanner recording",
                  {"rgb.mp4", "camera_matrix.csv", "odometry.csv"},
                  {"depth/", "rgb.mp4", "camera_matrix.csv"}},
        AppFolder{
            "a Polycam recording", {"keyframes/"}, {"keyframes/depth/", "keyframes/cameras/"}}};
    return kFolders;
}

bool Has(const fs::path& folder, const std::string& part) {
    std::error_code ignored;
    if (!part.ends_with('/')) return fs::is_regular_file(folder / part, ignored);
    if (part == "keyframes/cameras/" && Has(folder, "keyframes/corrected_cameras/")) return true;
    return fs::is_directory(folder / part, ignored);
}

const AppFolder* AppOf(const fs::path& folder) {
    for (const AppFolder& app : AppFolders())
        if (std::ranges::any_of(app.signs, [&](const char* sign) { return Has(folder, sign); }))
            return &app;
    return nullptr;
}

std::string MissingIn(const fs::path& folder, const AppFolder& app) {
    std::vector<std::string> missing;
    for (const char* part : app.parts)
        if (!Has(folder, part)) missing.emplace_back(part);
    if (missing.empty())  // it was refused all the same
        return std::string("this build does not read it: ") + kRecordingsUnavailable;
    std::string text;
    for (std::size_t i = 0; i < missing.size(); ++i)
        text += (i == 0 ? "" : i + 1 < missing.size() ? ", " : " and ") + missing[i];
    return text + (missing.size() == 1 ? " is missing" : " are missing") +
           "; copy the whole folder again";
}

std::string KindOf(const fs::path& recording) {
    if (const AppFolder* app = AppOf(recording)) return app->kind;
    return EndingOf(recording.string()) == ".r3d" ? "a Record3D recording" : "a recording";
}

std::string RecordingsIn(const fs::path& folder) {
    std::vector<std::string> names;
    std::error_code error;
    for (fs::directory_iterator at(folder, error), end; !error && at != end; at.increment(error))
        if (IsRecording(at->path().string())) names.push_back(at->path().filename().string());
    if (names.empty()) return {};
    std::ranges::sort(names);
    const std::string first = names.front() + ", " + KindOf(folder / names.front());
    return names.size() == 1
               ? fmt::format("contains {}; give it instead", first)
               : fmt::format("contains {}, and {} more; give one of them", first, names.size() - 1);
}

}  // namespace

std::string AboveRecording(const std::string& path) {
    std::error_code error;
    const fs::path folder = fs::canonical(path, error);
    if (error || Has(folder, "camera.yaml")) return {};
    if (folder.filename() != "keyframes" || !Has(folder.parent_path(), "keyframes/depth/") ||
        !Has(folder.parent_path(), "keyframes/cameras/"))
        return {};
    return "is the inner folder of a Polycam recording; give the folder above";
}

std::string DescribeWrongFolder(const std::string& path) {
    const fs::path folder = path;
    if (const AppFolder* app = AppOf(folder))
        return fmt::format("looks like {}; {}", app->kind, MissingIn(folder, *app));
    if (Has(folder, "rgbd/") && Has(folder, "metadata"))
        return "is an unpacked Record3D recording; give the .r3d file itself";
    if (Has(folder, "model.glb") || Has(folder, "model.obj"))
        return "holds a finished model, and is no source of frames";
    return RecordingsIn(folder);
}

}  // namespace tessera
