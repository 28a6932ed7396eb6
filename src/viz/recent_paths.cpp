#include "viz/recent_paths.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <sstream>

#include "core/input_file.h"
#include "core/printable.h"
#include "io/file.h"

namespace tessera {
namespace {

constexpr std::size_t kMostListBytes = std::size_t{1} << 20, kMostPathBytes = 4096;

bool IsKept(const std::string& path) {
    return path.starts_with('/') && path.size() <= kMostPathBytes && Printable(path) == path;
}

}  // namespace

std::string RecentFile() {
    const auto folder = [](const char* name) {
        const char* value = std::getenv(name);
        return value != nullptr && value[0] == '/' ? std::string(value) : std::string();
    };
    if (const std::string state = folder("XDG_STATE_HOME"); !state.empty())
        return state + "/tessera/recent";
    const std::string home = folder("HOME");
    return home.empty() ? "" : home + "/.local/state/tessera/recent";
}

std::vector<std::string> ReadRecentPaths(const std::string& file) {
    std::vector<std::string> paths;
    if (file.empty()) return paths;
    const Result<std::string> text = ReadWholeFile(file, kMostListBytes);
    if (!text.ok()) return paths;
    std::istringstream lines(text.value());
    for (std::string line; paths.size() < kMostRecent && std::getline(lines, line);)
        if (IsKept(line) && std::ranges::find(paths, line) == paths.end()) paths.push_back(line);
    return paths;
}

void AddRecentPath(const std::string& file, const std::string& path) {
    namespace fs = std::filesystem;
    std::error_code error;
    const std::string added = fs::absolute(path, error).lexically_normal().string();
    if (file.empty() || path.empty() || error || !IsKept(added)) return;
    std::vector<std::string> paths = ReadRecentPaths(file);
    std::erase(paths, added);
    paths.insert(paths.begin(), added);
    if (paths.size() > kMostRecent) paths.resize(kMostRecent);
    std::string text;
    for (const std::string& kept : paths) text += kept + "\n";
    fs::create_directories(fs::path(file).parent_path(), error);
    static_cast<void>(WriteTextFile(file, text));
}

}  // namespace tessera
