// Linked into the tests of AddressSanitizer builds. OpenNI2 2.2 and its player of .oni files never
// free some of their start-up allocations (device lists, event handles, codecs). Only allocations
// made by these libraries are suppressed. Leaks in the sources that use them are still reported.
#include <dlfcn.h>

extern "C" const char* __lsan_default_suppressions() {
    return "leak:libOpenNI2.so\nleak:libOniFile.so\n";
}

namespace {
// OpenNI2 unloads its drivers. The player stays loaded here, so that its leaks can be attributed.
[[maybe_unused]] void* const kPlayer = dlopen(TESSERA_ONI_PLAYER, RTLD_NOW | RTLD_NODELETE);
}  // namespace
