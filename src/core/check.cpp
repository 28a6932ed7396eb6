#include "core/check.h"

#include <cstdio>
#include <cstdlib>

namespace tessera {

void CheckFailed(const char* file, int line, const char* expression, const std::string& details) {
    std::fprintf(stderr, "%s:%d: check failed: %s (%s)\n", file, line, expression, details.c_str());
    std::abort();
}

}  // namespace tessera
