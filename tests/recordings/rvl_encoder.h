// Writes RVL from the publication: a list of nibbles, then words. No program in Debian writes it.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace tessera {

inline std::string RvlOf(std::span<const std::uint16_t> pixels) {
    std::vector<std::uint32_t> nibbles;
    const auto put = [&](std::uint32_t number) {
        for (; number >= 8; number /= 8) nibbles.push_back(8 + number % 8);
        nibbles.push_back(number);
    };
    int last = 0;
    for (std::size_t at = 0; at < pixels.size();) {
        std::size_t depth = at;
        while (depth < pixels.size() && pixels[depth] == 0) ++depth;
        std::size_t end = depth;
        while (end < pixels.size() && pixels[end] != 0) ++end;
        put(static_cast<std::uint32_t>(depth - at));
        put(static_cast<std::uint32_t>(end - depth));
        for (at = depth; at < end; ++at) {
            const int difference = pixels[at] - last;
            put(static_cast<std::uint32_t>(difference >= 0 ? 2 * difference : -2 * difference - 1));
            last = pixels[at];
        }
    }
    while (nibbles.size() % 8 != 0) nibbles.push_back(0);
    std::string code;
    for (std::size_t word = 0; word < nibbles.size(); word += 8)
        for (std::size_t byte = 4; byte-- > 0;)
            code += static_cast<char>(16 * nibbles[word + 2 * byte] + nibbles[word + 2 * byte + 1]);
    return code;
}

}  // namespace tessera
