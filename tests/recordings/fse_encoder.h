// Finite state entropy for the test encoder of LZFSE streams, from the definition of tabled
// asymmetric numeral systems (J. Duda, arXiv:1311.2540) rather than with tables.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <span>
#include <vector>

namespace tessera {

// Bits from the lowest of each byte on.
class BitWriter {
  public:
    void Push(std::uint32_t number, int bits) {
        for (int i = 0; i < bits; ++i, ++count_) {
            if (count_ % 8 == 0) bytes_.push_back(0);
            bytes_.back() =
                static_cast<std::uint8_t>(bytes_.back() | (number >> i & 1) << count_ % 8);
        }
    }
    int spare_bits() const { return static_cast<int>((8 - count_ % 8) % 8); }
    const std::vector<std::uint8_t>& bytes() const { return bytes_; }

  private:
    std::vector<std::uint8_t> bytes_;
    std::size_t count_ = 0;
};

// Shares `states` out among symbols by how often they occur; each that occurs gets at least one.
inline std::vector<std::uint16_t> FseFrequencies(std::span<const std::size_t> counts,
                                                 std::size_t states) {
    const std::size_t all = std::accumulate(counts.begin(), counts.end(), std::size_t{0});
    std::vector<std::uint16_t> frequencies(counts.size());
    if (all == 0) return frequencies;
    std::size_t given = 0;
    for (std::size_t i = 0; i < counts.size(); ++i) {
        if (counts[i] == 0) continue;
        const std::size_t share = std::max<std::size_t>(1, counts[i] * states / all);
        frequencies[i] = static_cast<std::uint16_t>(share);
        given += share;
    }
    for (; given > states; --given) --*std::ranges::max_element(frequencies);
    auto& largest = *std::ranges::max_element(frequencies);
    largest = static_cast<std::uint16_t>(largest + states - given);
    return frequencies;
}

// The state is a number from N to 2 N - 1. A symbol with f of the N states needs it in the range of
// f to 2 f - 1: its low bits are written and shifted out until it is. Its place in that range says
// which of the symbol's states comes next.
class FseEncoder {
  public:
    FseEncoder(std::vector<std::uint16_t> frequencies, std::size_t states)
        : frequencies_(std::move(frequencies)), first_(frequencies_.size()), states_(states) {
        std::exclusive_scan(frequencies_.begin(), frequencies_.end(), first_.begin(),
                            std::size_t{0});
    }

    std::uint16_t state() const { return static_cast<std::uint16_t>(state_); }
    void Encode(std::size_t symbol, BitWriter& out) {
        const std::size_t f = frequencies_[symbol], number = states_ + state_;
        int bits = 0;
        while (number >> bits >= 2 * f) ++bits;
        out.Push(static_cast<std::uint32_t>(number & ((std::size_t{1} << bits) - 1)), bits);
        state_ = first_[symbol] + (number >> bits) - f;
    }

  private:
    std::vector<std::uint16_t> frequencies_;
    std::vector<std::size_t> first_;  // state of each symbol
    std::size_t states_, state_ = 0;
};

}  // namespace tessera
