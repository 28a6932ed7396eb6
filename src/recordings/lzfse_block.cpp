#include "recordings/lzfse_block.h"

#include <bit>
#include <utility>

namespace tessera {
namespace {

using LzfseBytes = std::span<const std::uint8_t>;

// Reads numbers from the end of a payload to its start.
class LzfseBits {
  public:
    LzfseBits(LzfseBytes bytes, int spare_bits)
        : bytes_(bytes), left_(8 * bytes.size() - static_cast<std::size_t>(spare_bits)) {
        good_ = 8 * bytes.size() >= static_cast<std::size_t>(spare_bits);
    }

    bool good() const { return good_; }  // false: there were too few bits
    // The next up to 15 bits.
    std::uint32_t Pull(unsigned count) {
        if (!good_ || count > left_) {
            good_ = false;
            return 0;
        }
        left_ -= count;
        const std::size_t byte = left_ / 8;
        std::uint32_t word = 0;
        if (byte + sizeof(word) <= bytes_.size())
            std::memcpy(&word, bytes_.data() + byte, sizeof(word));
        else
            std::memcpy(&word, bytes_.data() + byte, bytes_.size() - byte);
        return word >> left_ % 8 & ((1u << count) - 1);
    }

  private:
    LzfseBytes bytes_;
    std::size_t left_;
    bool good_;
};

// What a state of the decoder stands for. The next state is `next` plus a number of some bits.
struct LzfseState {
    std::uint16_t next = 0;
    std::uint8_t bits = 0;
    std::uint8_t symbol = 0;
};

// A symbol with the frequency f has f states in a row. They get the numbers f to 2 f - 1, and each
// number gets bits from below until it is in the range of N to 2 N - 1, which are all N states.
// False: the frequencies are more than the states. They may be fewer; nothing leads to the others.
bool FillLzfseStates(std::span<const std::uint16_t> frequencies, std::span<LzfseState> states) {
    const auto all = static_cast<unsigned>(states.size());
    std::size_t filled = 0;
    for (std::size_t symbol = 0; symbol < frequencies.size(); ++symbol) {
        const unsigned frequency = frequencies[symbol];
        if (frequency > all - filled) return false;
        for (unsigned number = frequency; number < 2 * frequency; ++number) {
            const int bits = std::bit_width(all) - std::bit_width(number);
            states[filled++] = {static_cast<std::uint16_t>((number << bits) - all),
                                static_cast<std::uint8_t>(bits), static_cast<std::uint8_t>(symbol)};
        }
    }
    std::ranges::fill(states.subspan(filled), LzfseState{});
    return true;
}

// The numbers that a symbol stands for: `least` plus a number of some bits.
struct LzfseRange {
    std::uint32_t least = 0;
    unsigned bits = 0;
};

// Each range begins where the one before ends.
template <std::size_t kSymbols, typename BitsOf>
constexpr std::array<LzfseRange, kSymbols> LzfseRanges(BitsOf bits_of) {
    std::array<LzfseRange, kSymbols> ranges;
    std::uint32_t least = 0;
    for (std::size_t symbol = 0; symbol < kSymbols; ++symbol) {
        ranges[symbol] = {least, bits_of(symbol)};
        least += 1u << ranges[symbol].bits;
    }
    return ranges;
}

constexpr auto kLzfseLiteralLengths = LzfseRanges<kLzfseLengthSymbols>([](std::size_t symbol) {
    constexpr unsigned kLast[] = {2, 3, 5, 8};
    return symbol < 16 ? 0u : kLast[symbol - 16];
});
constexpr auto kLzfseMatchLengths = LzfseRanges<kLzfseLengthSymbols>([](std::size_t symbol) {
    constexpr unsigned kLast[] = {3, 5, 8, 11};
    return symbol < 16 ? 0u : kLast[symbol - 16];
});
constexpr auto kLzfseDistances = LzfseRanges<kLzfseDistanceSymbols>(
    [](std::size_t symbol) { return static_cast<unsigned>(symbol / 4); });

template <std::size_t kStates>
class LzfseNumbers {
  public:
    LzfseNumbers(std::span<const LzfseRange> ranges, std::span<const std::uint16_t> frequencies,
                 std::uint32_t state)
        : ranges_(ranges), state_(state) {
        good_ = state < kStates && FillLzfseStates(frequencies, states_);
    }

    bool good() const { return good_; }
    std::uint32_t Next(LzfseBits& bits) {
        const LzfseState state = states_[state_];
        state_ = state.next + bits.Pull(state.bits);
        const LzfseRange range = ranges_[state.symbol];
        return range.least + bits.Pull(range.bits);
    }

  private:
    std::span<const LzfseRange> ranges_;
    std::array<LzfseState, kStates> states_;
    std::uint32_t state_;
    bool good_;
};

// Four decoders take turns.
class LzfseLiterals {
  public:
    LzfseLiterals(const LzfseTables& tables, std::span<const std::uint16_t> frequencies,
                  LzfseBytes payload)
        : bits_(payload, tables.literal_spare_bits),
          left_(tables.literals),
          current_(tables.literal_states) {
        good_ = FillLzfseStates(frequencies, states_);
        for (const std::uint32_t state : current_) good_ = good_ && state < kLzfseLiteralStates;
    }

    bool good() const { return good_; }
    bool Copy(std::uint32_t count, LzOutput& output) {
        if (count > left_ || count > output.room()) return false;
        left_ -= count;
        for (; count > 0; --count) {
            std::uint32_t& current = current_[turn_++ % 4];
            const LzfseState state = states_[current];
            current = state.next + bits_.Pull(state.bits);
            if (!output.Literal(state.symbol)) return false;
        }
        return bits_.good();
    }

  private:
    LzfseBits bits_;
    std::uint32_t left_;
    std::array<std::uint32_t, 4> current_;
    unsigned turn_ = 0;
    std::array<LzfseState, kLzfseLiteralStates> states_;
    bool good_;
};

}  // namespace

bool DecodeLzfseBlock(const LzfseTables& tables, LzfseBytes payload, LzOutput& output) {
    std::span<const std::uint16_t> rest = tables.frequencies;
    const auto take = [&rest](std::size_t count) {
        return std::exchange(rest, rest.subspan(count)).first(count);
    };
    LzfseNumbers<kLzfseLengthStates> literal_lengths(
        kLzfseLiteralLengths, take(kLzfseLengthSymbols), tables.literal_length_state);
    LzfseNumbers<kLzfseLengthStates> match_lengths(kLzfseMatchLengths, take(kLzfseLengthSymbols),
                                                   tables.match_length_state);
    LzfseNumbers<kLzfseDistanceStates> distances(kLzfseDistances, take(kLzfseDistanceSymbols),
                                                 tables.distance_state);
    LzfseLiterals literals(tables, rest, payload.first(tables.literal_bytes));
    if (!literal_lengths.good() || !match_lengths.good() || !distances.good() || !literals.good())
        return false;

    LzfseBits bits(payload.subspan(tables.literal_bytes), tables.match_spare_bits);
    std::size_t distance = 0;
    for (std::uint32_t i = 0; i < tables.matches; ++i) {
        const std::uint32_t literal_length = literal_lengths.Next(bits);
        const std::uint32_t match_length = match_lengths.Next(bits);
        // 0: the same as before.
        if (const std::uint32_t given = distances.Next(bits); given > 0) distance = given;
        // No encoder writes an empty step. A hostile one could take millions of them.
        if (!bits.good() || literal_length + match_length == 0) return false;
        if (!literals.Copy(literal_length, output)) return false;
        if (match_length > 0 && !output.Match(distance, match_length)) return false;
    }
    return true;
}

}  // namespace tessera
