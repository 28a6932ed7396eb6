// Text files written whole or not at all, and folders made ready for output.
#pragma once

#include <string>

#include "core/status.h"

namespace tessera {

// Writes beside `path`, syncs and renames; says what failed (no space left, not writable) and leaves no debris.
Status WriteTextFile(const std::string& path, const std::string& text);

// Makes the folder (and its parents) and proves that it can be written to.
Status PrepareOutputFolder(const std::string& path);

}  // namespace tessera
