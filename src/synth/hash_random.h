// Random numbers as a function of seed, stream and counter: reproducible in any order and for any
// number of threads. Plain functions, thread-safe.
#pragma once

#include <cstdint>

namespace tessera {

// Finaliser of SplitMix64: a bijection on 64 bits. On counters its output passes the usual test
// batteries.
inline std::uint64_t MixBits(std::uint64_t x) {
    x += 0x9e3779b97f4a7c15ull;
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ull;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebull;
    return x ^ (x >> 31);
}

// Key of a stream of numbers; its number `counter` is MixBits(key + counter).
inline std::uint64_t StreamKey(std::uint64_t seed, std::uint64_t stream,
                               std::uint64_t substream = 0) {
    return MixBits(MixBits(MixBits(seed) ^ stream) ^ substream);
}

// Uniform in [0, 1), 53 bits.
inline double UniformFromBits(std::uint64_t bits) {
    return static_cast<double>(bits >> 11) * 0x1.0p-53;
}

// Mean 0, standard deviation 1. Sum of the four 16-bit parts: within +-3.46 and close to a
// Gaussian.
inline float GaussianFromBits(std::uint64_t bits) {
    const std::uint32_t sum = static_cast<std::uint32_t>((bits & 0xffff) + (bits >> 16 & 0xffff) +
                                                         (bits >> 32 & 0xffff) + (bits >> 48));
    constexpr float kMean = 4 * 32767.5f;
    constexpr float kInverseStd = 1.0f / 37837.23f;  // 65536 * sqrt(4 / 12)
    return (static_cast<float>(sum) - kMean) * kInverseStd;
}

}  // namespace tessera
