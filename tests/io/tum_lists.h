// A folder with the lists of two images of each kind, as TUM RGB-D sequences have them.
#pragma once

#include "io/temporary_folder.h"

namespace tessera {

inline void WriteTumLists(const TemporaryFolder& folder) {
    folder.WriteText("depth.txt", "1.0 depth/1.png\n2.0 depth/2.png\n");
    folder.WriteText("rgb.txt", "1.0 rgb/1.png\n2.0 rgb/2.png\n");
    for (const char* name : {"depth/1.png", "depth/2.png", "rgb/1.png", "rgb/2.png"})
        folder.WriteText(name, "");
}

}  // namespace tessera
