// Finds the literals and matches that the test encoders write.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

namespace tessera {

// Some literals, then a match.
struct LzStep {
    std::size_t literals = 0, match = 0, distance = 0;
};

inline std::size_t LzMatchLength(std::span<const std::uint8_t> bytes, std::size_t from,
                                 std::size_t at) {
    std::size_t length = 0;
    while (at + length < bytes.size() && bytes[from + length] == bytes[at + length]) ++length;
    return length;
}

// Greedy: takes the nearest match of at least 4 bytes. Runs of literals are cut at 5000.
inline std::vector<LzStep> FindLzSteps(std::span<const std::uint8_t> bytes,
                                       std::size_t most_distance) {
    constexpr std::size_t kLeast = 4, kMostLiterals = 5000;
    std::unordered_map<std::uint32_t, std::size_t> last_place;
    std::vector<LzStep> steps;
    std::size_t literals = 0;
    for (std::size_t at = 0; at < bytes.size();) {
        std::size_t match = 0, distance = 0;
        if (at + kLeast <= bytes.size()) {
            std::uint32_t key = 0;
            for (std::size_t i = 0; i < kLeast; ++i) key = key << 8 | bytes[at + i];
            const auto [place, is_new] = last_place.try_emplace(key, at);
            if (!is_new) {
                distance = at - place->second;
                if (distance <= most_distance) match = LzMatchLength(bytes, place->second, at);
                place->second = at;
            }
        }
        if (match > 0 || ++literals == kMostLiterals) {
            steps.push_back({literals, match, match > 0 ? distance : 1});
            literals = 0;
        }
        at += std::max<std::size_t>(match, 1);
    }
    if (literals > 0) steps.push_back({literals, 0, 1});
    return steps;
}

}  // namespace tessera
