// Linked into the tests of ThreadSanitizer builds: TBB's loops run on the calling thread. Debian's
// TBB is not built for ThreadSanitizer, which therefore cannot see that a loop ends before what
// follows it, and reports every loop. The threads, queues and atomics of this project run as ever
// and are watched.
#include <tbb/global_control.h>

namespace {
const tbb::global_control kSerial(tbb::global_control::max_allowed_parallelism, 1);
}  // namespace
