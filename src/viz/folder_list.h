// The content of a folder, as far as it can be opened: folders, recordings, scans and meshes.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace tessera {

struct FolderEntry {
    std::string path;  // in the form of the folder's
    std::string name;  // printable
    bool folder = false;
};

struct FolderList {
    std::vector<FolderEntry> entries;  // folders first, each kind by name
    std::string note;                  // why some or all are missing; empty if none
};

// At most this many entries are listed; of a folder with many more, only the first are looked at.
inline constexpr std::size_t kMostListed = 500, kMostLookedAt = 20000;

// "." or "" is the current folder; its entries then have relative paths. Hidden entries are left
// out.
FolderList ListFolder(const std::string& folder);
// The folder that holds it: "." if that is the current one, else its absolute path; "/" stays.
std::string FolderAbove(const std::string& folder);

}  // namespace tessera
