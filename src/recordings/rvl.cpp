#include "recordings/rvl.h"

#include <algorithm>

namespace tessera {
namespace {

// Reads numbers of three bits per nibble, lowest bits first; a nibble's highest bit says that
// another follows. Nibbles fill words of 32 bits from the top, and words are little-endian.
class RvlNumbers {
  public:
    explicit RvlNumbers(std::span<const std::uint8_t> code) : code_(code) {}

    // False if the code ends in the number, or if the number has more than 32 bits.
    bool Next(std::uint32_t& number) {
        constexpr int kMostNibbles = 11;
        std::uint64_t value = 0;
        for (int i = 0; i < kMostNibbles; ++i) {
            // Byte 3 of a word is its first; of a byte, the upper nibble.
            const std::size_t byte = (nibble_ / 8) * 4 + 3 - nibble_ % 8 / 2;
            if (byte >= code_.size()) return false;
            const auto nibble =
                static_cast<std::uint32_t>(nibble_ % 2 == 0 ? code_[byte] >> 4 : code_[byte] & 15);
            ++nibble_;
            value |= static_cast<std::uint64_t>(nibble & 7) << (3 * i);
            if (nibble < 8) {
                number = static_cast<std::uint32_t>(value);
                return value <= 0xffffffffu;
            }
        }
        return false;
    }

  private:
    std::span<const std::uint8_t> code_;
    std::size_t nibble_ = 0;
};

}  // namespace

// Pairs of runs: pixels without depth, then pixels with depth, each as the difference to the last
// depth. A difference's sign is its lowest bit.
bool DecodeRvl(std::span<const std::uint8_t> code, std::span<std::uint16_t> pixels) {
    RvlNumbers numbers(code);
    std::uint32_t last = 0;
    while (!pixels.empty()) {
        std::uint32_t without = 0, with = 0;
        if (!numbers.Next(without) || without > pixels.size()) return false;
        std::ranges::fill(pixels.first(without), std::uint16_t{0});
        pixels = pixels.subspan(without);
        if (!numbers.Next(with) || with > pixels.size()) return false;
        for (std::uint16_t& pixel : pixels.first(with)) {
            std::uint32_t difference = 0;
            if (!numbers.Next(difference)) return false;
            last += (difference >> 1) ^ (0 - (difference & 1));
            if (last > 0xffff) return false;
            pixel = static_cast<std::uint16_t>(last);
        }
        pixels = pixels.subspan(with);
    }
    return true;
}

}  // namespace tessera
