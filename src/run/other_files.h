// Files and folders that are no source of frames, but that people try.
#pragma once

#include <string>

namespace tessera {

// What it is, and the command that uses it, in one line: "a mesh; tessera view a.ply shows it".
// Empty if it is nothing known. Judges by name, and looks into text files only.
std::string DescribeOtherFile(const std::string& path);

}  // namespace tessera
