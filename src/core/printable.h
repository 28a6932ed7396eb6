// Text that came from outside (a file, a name, a library) made safe to show.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace tessera {

// One line of valid UTF-8 without control characters: no escape sequence reaches a terminal, no
// character turns the direction of a line, and no JSON writer or Python string fails on it. Each
// other byte becomes "\xNN". Text of more than `most_bytes` is cut and ends with "...".
std::string Printable(std::string_view text, std::size_t most_bytes = std::string_view::npos);

// For a value quoted in a message.
inline constexpr std::size_t kQuotedBytes = 60;

// The words as a POSIX shell reads them again, quoted where needed: for each command that is shown.
std::string ShellLine(const std::vector<std::string>& words);

}  // namespace tessera
