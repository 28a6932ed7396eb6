// Words of a text that a person or another program has written.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace tessera {

// The words between `separators`, none of them empty. They refer to `text`.
std::vector<std::string_view> SplitWords(std::string_view text, std::string_view separators);

// Insertions, deletions and changes that turn one word into the other.
std::size_t EditDistance(const std::string& a, const std::string& b);

}  // namespace tessera
