#include "core/worker.h"

#include <sys/resource.h>
#include <unistd.h>

namespace tessera {

void LowerThreadPriority() {
    constexpr int kNice = 10;
    static_cast<void>(setpriority(PRIO_PROCESS, static_cast<id_t>(gettid()), kNice));
}

}  // namespace tessera
