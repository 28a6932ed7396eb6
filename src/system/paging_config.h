// Limits how much of the map is kept in memory.
#pragma once

#include "core/config.h"

namespace tessera {

struct PagingConfig {
    double memory_limit_mb = 0;  // 0: no limit

    bool enabled() const { return memory_limit_mb > 0; }
    void Describe(ConfigParameters& parameters);
};

}  // namespace tessera
