// The 80 COCO class names in their usual order. Most published detectors use them.
#pragma once

#include <string>
#include <vector>

namespace tessera {

std::vector<std::string> CocoNames();

}  // namespace tessera
