#include "recordings/lzfse_header.h"

#include <bit>
#include <cstring>
#include <string_view>

namespace tessera {
namespace {

using LzfseBytes = std::span<const std::uint8_t>;

static_assert(std::endian::native == std::endian::little, "numbers are read in place");

template <typename Number>
Number LzfseNumber(LzfseBytes bytes, std::size_t offset) {
    Number number;
    std::memcpy(&number, bytes.data() + offset, sizeof(number));
    return number;
}

// A frequency is a prefix of up to four ones, ended by a zero unless there are four, and then some
// bits of the number. All of it begins at the low bits.
bool ReadLzfseFrequencies(LzfseBytes bytes, LzfseTables& tables) {
    constexpr int kPrefixBits[] = {1, 2, 3, 4, 4}, kBits[] = {1, 1, 2, 4, 10};
    constexpr unsigned kLeast[] = {0, 2, 4, 8, 24};
    std::uint32_t pending = 0;
    int there = 0;
    std::size_t read = 0;
    for (std::uint16_t& frequency : tables.frequencies) {
        for (; there <= 24 && read < bytes.size(); there += 8)
            pending |= std::uint32_t{bytes[read++]} << there;
        const int ones = std::min(std::countr_one(pending), 4);
        const int used = kPrefixBits[ones] + kBits[ones];
        if (used > there) return false;
        const std::uint32_t number = pending >> kPrefixBits[ones] & ((1u << kBits[ones]) - 1);
        frequency = static_cast<std::uint16_t>(kLeast[ones] + number);
        pending >>= used;
        there -= used;
    }
    return read == bytes.size() && there < 8;
}

// "bvx1": every number at its full width.
bool ReadLzfseWide(LzfseBytes stream, LzfseHeader& header) {
    constexpr std::size_t kBytes = 772, kFrequencies = 50;
    if (stream.size() < kBytes) return false;
    LzfseTables& t = header.tables;
    header.header_bytes = kBytes;
    t.literals = LzfseNumber<std::uint32_t>(stream, 12);
    t.matches = LzfseNumber<std::uint32_t>(stream, 16);
    t.literal_bytes = LzfseNumber<std::uint32_t>(stream, 20);
    t.match_bytes = LzfseNumber<std::uint32_t>(stream, 24);
    const auto literal_bits = LzfseNumber<std::int32_t>(stream, 28);
    const auto match_bits = LzfseNumber<std::int32_t>(stream, 40);
    if (literal_bits < -7 || literal_bits > 0 || match_bits < -7 || match_bits > 0) return false;
    t.literal_spare_bits = -literal_bits;
    t.match_spare_bits = -match_bits;
    for (std::size_t i = 0; i < t.literal_states.size(); ++i)
        t.literal_states[i] = LzfseNumber<std::uint16_t>(stream, 32 + 2 * i);
    t.literal_length_state = LzfseNumber<std::uint16_t>(stream, 44);
    t.match_length_state = LzfseNumber<std::uint16_t>(stream, 46);
    t.distance_state = LzfseNumber<std::uint16_t>(stream, 48);
    std::memcpy(t.frequencies.data(), stream.data() + kFrequencies, sizeof(t.frequencies));
    return true;
}

// "bvx2": the numbers in three words, and the frequencies in few bits each.
bool ReadLzfsePacked(LzfseBytes stream, LzfseHeader& header) {
    constexpr std::size_t kFrequencies = 32;
    if (stream.size() < kFrequencies) return false;
    const auto field = [&](std::size_t word, int first_bit, int bits) {
        const auto number = LzfseNumber<std::uint64_t>(stream, 8 + 8 * word);
        return static_cast<std::uint32_t>(number >> first_bit & ((std::uint64_t{1} << bits) - 1));
    };
    LzfseTables& t = header.tables;
    t.literals = field(0, 0, 20);
    t.literal_bytes = field(0, 20, 20);
    t.matches = field(0, 40, 20);
    t.literal_spare_bits = 7 - static_cast<int>(field(0, 60, 3));
    for (int i = 0; i < 4; ++i)
        t.literal_states[static_cast<std::size_t>(i)] = field(1, 10 * i, 10);
    t.match_bytes = field(1, 40, 20);
    t.match_spare_bits = 7 - static_cast<int>(field(1, 60, 3));
    header.header_bytes = field(2, 0, 32);
    t.literal_length_state = field(2, 32, 10);
    t.match_length_state = field(2, 42, 10);
    t.distance_state = field(2, 52, 10);
    if (header.header_bytes < kFrequencies || header.header_bytes > stream.size()) return false;
    return ReadLzfseFrequencies(stream.subspan(kFrequencies, header.header_bytes - kFrequencies),
                                t);
}

bool ReadLzfseFse(LzfseBytes stream, bool packed, LzfseHeader& header) {
    header.code = LzfseCode::kFse;
    if (!(packed ? ReadLzfsePacked(stream, header) : ReadLzfseWide(stream, header))) return false;
    header.payload_bytes = std::uint64_t{header.tables.literal_bytes} + header.tables.match_bytes;
    return true;
}

bool ReadLzfsePlain(LzfseBytes stream, LzfseCode code, LzfseHeader& header) {
    header.code = code;
    header.header_bytes = code == LzfseCode::kLzvn ? 12 : 8;
    if (stream.size() < header.header_bytes) return false;
    header.payload_bytes =
        code == LzfseCode::kLzvn ? LzfseNumber<std::uint32_t>(stream, 8) : header.bytes;
    return true;
}

}  // namespace

std::optional<LzfseHeader> ReadLzfseHeader(LzfseBytes stream) {
    LzfseHeader header;
    if (stream.size() < 4) return std::nullopt;
    const std::string_view magic(reinterpret_cast<const char*>(stream.data()), 4);
    if (magic == "bvx$") {
        header.header_bytes = 4;
        return header;
    }
    if (stream.size() < 8) return std::nullopt;
    header.bytes = LzfseNumber<std::uint32_t>(stream, 4);
    const bool good = magic == "bvx-"   ? ReadLzfsePlain(stream, LzfseCode::kRaw, header)
                      : magic == "bvxn" ? ReadLzfsePlain(stream, LzfseCode::kLzvn, header)
                      : magic == "bvx1" ? ReadLzfseFse(stream, false, header)
                      : magic == "bvx2" ? ReadLzfseFse(stream, true, header)
                                        : false;
    if (!good || header.payload_bytes > stream.size() - header.header_bytes) return std::nullopt;
    return header;
}

}  // namespace tessera
