// Linked into the tests of AddressSanitizer builds: OpenNI2 2.2 and its player of .oni files never
// free some of what they allocate when they start (device lists, event handles, codecs). Only what
// they themselves allocate is let pass; leaks of the sources that use them are found as ever.
#include <dlfcn.h>

extern "C" const char* __lsan_default_suppressions() {
    return "leak:libOpenNI2.so\nleak:libOniFile.so\n";
}

namespace {
// OpenNI2 unloads its drivers; kept loaded, their leaks can be told by their names.
[[maybe_unused]] void* const kPlayer = dlopen(TESSERA_ONI_PLAYER, RTLD_NOW | RTLD_NODELETE);
}  // namespace
