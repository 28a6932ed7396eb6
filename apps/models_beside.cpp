#include "models_beside.h"

#include <filesystem>
#include <set>

namespace tessera {

std::vector<std::string> ModelsBeside(const std::string& given) {
    namespace fs = std::filesystem;
    std::set<std::string> found;
    for (const fs::path& folder : {fs::path(given).parent_path(), fs::path("models")}) {
        std::error_code error;
        if (folder.empty()) continue;
        for (const auto& entry : fs::directory_iterator(folder, error))
            if (const auto end = entry.path().extension(); end == ".onnx" || end == ".cfg")
                found.insert(entry.path().string());
    }
    if (!given.empty()) found.insert(given);
    return {found.begin(), found.end()};
}

}  // namespace tessera
