#include "system/paging_config.h"

namespace tessera {

void PagingConfig::Describe(ConfigParameters& p) {
    p.Add("memory_limit_mb", memory_limit_mb, {0.0, 1e6}, "MB",
          "most memory of the map's blocks, 0 = no limit: what is far from the camera goes to the "
          "file of --scan and comes back "
          "before it is seen; what the camera may see from one place must fit");
}

}  // namespace tessera
