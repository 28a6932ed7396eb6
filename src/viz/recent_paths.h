// The files and folders that were opened last, kept for the next start of the program. What the
// file holds is not trusted.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace tessera {

inline constexpr std::size_t kMostRecent = 20;

// $XDG_STATE_HOME/tessera/recent or ~/.local/state/tessera/recent; empty if the environment names
// neither with an absolute path.
std::string RecentFile();

// Newest first, at most kMostRecent. Lines that are no absolute path, too long, not printable or
// repeated are left out; a file that cannot be read, or has more than a megabyte, is an empty list.
std::vector<std::string> ReadRecentPaths(const std::string& file);

// Puts the path, made absolute, first. A list that cannot be written stays as it is: it is a
// convenience. Nothing is kept if `file` is empty.
void AddRecentPath(const std::string& file, const std::string& path);

}  // namespace tessera
