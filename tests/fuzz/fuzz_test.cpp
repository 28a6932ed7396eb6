// The fuzz targets without a fuzzer: every seed, what a fuzzer once found, and a fixed number of
// mutations of each. tests/fuzz/found has one folder per target.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>

#include "fuzz/fuzz_target.h"

namespace tessera::fuzz {
namespace {

// One to four changes: a bit, a byte, a number at its limits, a piece removed, doubled, or taken
// from the other input.
Bytes Mutated(Bytes bytes, const Bytes& other, std::mt19937& random) {
    const auto below = [&](std::size_t limit) { return limit == 0 ? 0 : random() % limit; };
    for (std::size_t n = 1 + below(4); n > 0 && !bytes.empty(); --n) {
        const std::size_t at = below(bytes.size());
        const std::size_t piece =
            std::min(bytes.size() - at, 1 + below(random() % 8 == 0 ? 4096 : 16));
        const auto begin = bytes.begin() + static_cast<std::ptrdiff_t>(at);
        const auto end = begin + static_cast<std::ptrdiff_t>(piece);
        switch (below(7)) {
            case 0: bytes[at] ^= static_cast<std::uint8_t>(1u << below(8)); break;
            case 1: bytes[at] = static_cast<std::uint8_t>(random()); break;
            case 2: std::fill(begin, end, std::uint8_t{0xff}); break;
            case 3:
                std::fill(begin, end, random() % 2 == 0 ? std::uint8_t{0} : std::uint8_t{'9'});
                break;
            case 4: bytes.erase(begin, end); break;
            case 5: {
                const Bytes copy(begin, end);
                bytes.insert(begin, copy.begin(), copy.end());
                break;
            }
            default: {
                const std::size_t from = below(other.size());
                const std::size_t count = std::min(piece, other.size() - from);
                std::copy_n(other.begin() + static_cast<std::ptrdiff_t>(from), count, begin);
            }
        }
    }
    if (random() % 8 == 0) bytes.resize(below(bytes.size() + 1));
    return bytes;
}

std::vector<Bytes> Found(const std::string& target) {
    std::vector<Bytes> inputs;
    std::error_code ignored;
    for (const auto& entry : std::filesystem::directory_iterator(
             std::filesystem::path(TESSERA_FUZZ_FOUND) / target, ignored)) {
        std::ifstream file(entry.path(), std::ios::binary);
        inputs.emplace_back(std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>());
    }
    return inputs;
}

class Fuzz : public testing::TestWithParam<FuzzTarget> {};

TEST_P(Fuzz, NoInputBreaksAPromise) {
    const FuzzTarget& target = GetParam();
    std::vector<Bytes> inputs = target.seeds();
    for (const Bytes& seed : inputs) target.run(seed);
    for (Bytes& found : Found(target.name)) {
        target.run(found);
        inputs.push_back(std::move(found));
    }
    std::mt19937 random(1);
    for (int i = 0; i < target.mutations; ++i)
        target.run(
            Mutated(inputs[random() % inputs.size()], inputs[random() % inputs.size()], random));
}

INSTANTIATE_TEST_SUITE_P(Target, Fuzz, testing::ValuesIn(FuzzTargets()),
                         [](const auto& target) { return target.param.name; });

}  // namespace
}  // namespace tessera::fuzz
