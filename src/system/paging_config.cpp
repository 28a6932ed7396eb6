#include "system/paging_config.h"

namespace tessera {

void PagingConfig::Describe(ConfigParameters& p) {
    p.Add("memory_limit_mb", memory_limit_mb, {0.0, 1e6}, "MB",
          "maximum memory for the map's blocks, 0 = no limit: blocks far from the camera are moved "
          "to the file of --scan and loaded again before the camera sees them; all that the camera "
          "may see from one place must fit");
}

}  // namespace tessera
