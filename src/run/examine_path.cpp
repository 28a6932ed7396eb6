#include "run/examine_path.h"

#include <fmt/format.h>

#include <filesystem>

#include "recordings/endings.h"
#include "run/open_source.h"
#include "run/other_files.h"
#include "scan/scan_content.h"

namespace tessera {
namespace {

std::string DescribeSource(const SourceInfo& info) {
    std::string text = "A recording: " + info.kind;
    if (info.frame_count >= 0)
        text += fmt::format(", {} pair{} of colour and depth", info.frame_count,
                            info.frame_count == 1 ? "" : "s");
    text += fmt::format(", {} x {}", info.camera.width, info.camera.height);
    if (!info.camera_known) text += ", camera unknown";
    if (info.has_truth) text += ", with the true path";
    if (!info.warnings.empty()) text += "; " + info.warnings.front();
    return Printable(text);
}

ExaminedPath Examined(bool can_run, bool can_view, const std::string& text) {
    return {can_run, can_view, false, Printable(text)};
}

}  // namespace

ExaminedPath ExaminePath(const std::string& path, const RunConfig& config) {
    namespace fs = std::filesystem;
    std::error_code ignored;
    if (IsLiveSource(path)) return Examined(true, false, "Live frames.");
    const bool is_folder = fs::is_directory(path, ignored);
    const std::string other = DescribeOtherFile(path);
    const bool mesh = EndingOf(path) == ".ply" || fs::exists(fs::path(path) / "mesh.ply", ignored);
    if (!other.empty() && mesh) return Examined(false, true, "This is " + other + ".");
    const bool scan = EndingOf(path) == ".scan" && fs::is_regular_file(path, ignored);
    const Result<std::unique_ptr<FrameSource>> source = OpenSource(path, config);
    if (source.ok()) {
        const std::string text = DescribeSource(source.value()->info());
        return Examined(true, scan || (is_folder && mesh), text);
    }
    if (scan && ReadScanMeta(path).ok())
        return Examined(false, true, "A saved scan. To scan again: " + source.message());
    if (is_folder && mesh) return Examined(false, true, "A folder with a mesh.");
    return {false, false, true, source.message()};
}

}  // namespace tessera
