#include "viz/folder_list.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <string_view>

#include "core/printable.h"
#include "recordings/endings.h"

namespace tessera {
namespace {

namespace fs = std::filesystem;

constexpr std::array<std::string_view, 9> kEndings{".oni", ".klg", ".bag",  ".mcap", ".db3",
                                                   ".mkv", ".r3d", ".sens", ".scan"};

bool CanBeOpened(const std::string& path) {
    const std::string ending = EndingOf(path);
    return ending == ".ply" || std::ranges::find(kEndings, ending) != kEndings.end();
}

bool IsHere(const std::string& folder) { return folder.empty() || folder == "."; }

}  // namespace

FolderList ListFolder(const std::string& folder) {
    FolderList list;
    std::error_code error;
    fs::directory_iterator files(IsHere(folder) ? "." : folder, error);
    if (error) {
        list.note = Printable(fmt::format("{}: {}", folder, error.message()));
        return list;
    }
    std::size_t seen = 0;
    for (; files != fs::directory_iterator() && !error && seen < kMostLookedAt;
         files.increment(error), ++seen) {
        const std::string name = files->path().filename().string();
        std::error_code ignored;
        const bool is_folder = files->is_directory(ignored);
        if (name.starts_with('.') || (!is_folder && !CanBeOpened(name))) continue;
        const std::string path = !IsHere(folder)               ? (fs::path(folder) / name).string()
                                 : name.find(':') == name.npos ? name
                                                               : "./" + name;  // no kind of source
        list.entries.push_back({path, Printable(name, 200), is_folder});
    }
    std::ranges::sort(list.entries, [](const FolderEntry& a, const FolderEntry& b) {
        return a.folder != b.folder ? a.folder : a.name < b.name;
    });
    const bool more = list.entries.size() > kMostListed || seen == kMostLookedAt;
    if (list.entries.size() > kMostListed) list.entries.resize(kMostListed);
    if (more) list.note = "there are more: type the path";
    if (list.entries.empty() && !more) list.note = "nothing here that can be opened";
    return list;
}

std::string FolderAbove(const std::string& folder) {
    std::error_code error;
    const fs::path path = fs::absolute(IsHere(folder) ? "." : folder, error).lexically_normal();
    if (error) return folder;
    const fs::path whole = path.has_filename() ? path : path.parent_path();  // no last slash
    const fs::path above = whole.parent_path();
    return above == fs::current_path(error) ? "." : above.string();
}

}  // namespace tessera
