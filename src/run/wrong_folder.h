// Folders that are no source but nearly one: the folder above or below a recording, or a phone
// app's folder from which a part is missing. All such advice is here.
#pragma once

#include <string>

namespace tessera {

// What to give instead of a folder that would open as something else. Empty: nothing known.
std::string AboveRecording(const std::string& path);

// What a folder of no known layout looks like and what is missing, or the recordings in it. Empty:
// nothing known.
std::string DescribeWrongFolder(const std::string& path);

}  // namespace tessera
