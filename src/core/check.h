// Checks for bugs in this program. A failed check aborts and prints file, line and values. Do not
// use it for bad input (return a Status) or for conditions that are expected at run time (return a
// value).
#pragma once

#include <fmt/format.h>

#include <string>

namespace tessera {

[[noreturn]] void CheckFailed(const char* file, int line, const char* expression,
                              const std::string& details);

}  // namespace tessera

// TESSERA_CHECK(index < size, "index {} size {}", index, size)
#define TESSERA_CHECK(expression, ...)                                                         \
    do {                                                                                       \
        if (!(expression)) [[unlikely]]                                                        \
            ::tessera::CheckFailed(__FILE__, __LINE__, #expression, fmt::format(__VA_ARGS__)); \
    } while (false)
