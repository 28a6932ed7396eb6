// Linked into the tests of ThreadSanitizer builds. Makes TBB loops run on the calling thread.
// Debian's TBB is not built for ThreadSanitizer, so ThreadSanitizer cannot see that a loop ends
// before the code after it runs, and would report every loop. The threads, queues and atomics of
// this project still run in parallel and are checked.
#include <tbb/global_control.h>

namespace {
const tbb::global_control kSerial(tbb::global_control::max_allowed_parallelism, 1);
}  // namespace
