// Detection networks that can be chosen in a window.
#pragma once

#include <string>
#include <vector>

namespace tessera {

// The networks (.onnx, .cfg) in the folder of the one given, and in ./models, with the given one
// itself. Sorted; `given` may be empty.
std::vector<std::string> ModelsBeside(const std::string& given);

}  // namespace tessera
