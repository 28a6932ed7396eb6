// The ending of a file's name, by which recordings are told apart.
#pragma once

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <string>

namespace tessera {

// ".bag" of "a/B.BAG"; "" if there is none.
inline std::string EndingOf(const std::string& path) {
    std::string ending = std::filesystem::path(path).extension().string();
    std::ranges::transform(ending, ending.begin(),
                           [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return ending;
}

}  // namespace tessera
