#include "recordings/lzfse_encoder.h"

#include <array>
#include <string_view>

#include "recordings/fse_encoder.h"
#include "recordings/lz_steps.h"
#include "recordings/lzvn_encoder.h"

namespace tessera {
namespace {

using Bytes = std::vector<std::uint8_t>;

// A number as a symbol and the bits above the symbol's least number.
struct Coded {
    std::size_t symbol = 0;
    std::uint32_t above = 0;
    int bits = 0;
};

// Lengths up to 15 are symbols themselves; the last four symbols have these least numbers.
Coded CodeLength(std::size_t length, const std::array<std::size_t, 4>& least,
                 const std::array<int, 4>& bits) {
    if (length < 16) return {length, 0, 0};
    std::size_t i = 3;
    while (length < least[i]) --i;
    return {16 + i, static_cast<std::uint32_t>(length - least[i]), bits[i]};
}

Coded CodeLiterals(std::size_t n) { return CodeLength(n, {16, 20, 28, 60}, {2, 3, 5, 8}); }
Coded CodeMatch(std::size_t n) { return CodeLength(n, {16, 24, 56, 312}, {3, 5, 8, 11}); }

// Four symbols for each number of bits: (4 + i) 2^bits - 4 is the least number of the i-th.
Coded CodeDistance(std::size_t distance) {
    const auto least = [](std::size_t symbol) { return ((4 + symbol % 4) << symbol / 4) - 4; };
    std::size_t symbol = 63;
    while (distance < least(symbol)) --symbol;
    return {symbol, static_cast<std::uint32_t>(distance - least(symbol)),
            static_cast<int>(symbol / 4)};
}

struct CodedStep {
    Coded literals, match, distance;
};

// Steps no longer than the format allows, with distance 0 where it is the one before.
std::vector<CodedStep> CodeSteps(std::span<const LzStep> steps) {
    constexpr std::size_t kMostLiterals = 315, kMostMatch = 2359;
    std::vector<CodedStep> coded;
    std::size_t before = 0;
    const auto add = [&](std::size_t literals, std::size_t match, std::size_t distance) {
        const std::size_t given = distance == before ? 0 : distance;
        coded.push_back({CodeLiterals(literals), CodeMatch(match), CodeDistance(given)});
        before = distance;
    };
    for (LzStep step : steps) {
        for (; step.literals > kMostLiterals; step.literals -= kMostLiterals)
            add(kMostLiterals, 0, 1);
        for (; step.match > kMostMatch; step.match -= kMostMatch, step.literals = 0)
            add(step.literals, kMostMatch, step.distance);
        add(step.literals, step.match, step.distance);
    }
    return coded;
}

template <typename Number>
void Put(Bytes& bytes, Number number) {
    for (std::size_t i = 0; i < sizeof(number); ++i)
        bytes.push_back(static_cast<std::uint8_t>(std::uint64_t{number} >> 8 * i));
}

void PutMagic(Bytes& bytes, std::string_view magic) {
    bytes.insert(bytes.end(), magic.begin(), magic.end());
}

// One block in finite state entropy: everything but how its header is written.
struct FseBlock {
    std::uint32_t bytes = 0, literals = 0, steps = 0;
    std::vector<std::uint16_t> frequencies;  // of all four codes in a row
    std::array<std::uint16_t, 4> literal_states{};
    std::uint16_t l_state = 0, m_state = 0, d_state = 0;
    BitWriter literal_bits, step_bits;

    void EncodeLiterals(std::span<const std::uint8_t> run) {
        Bytes padded(run.begin(), run.end());
        while (padded.size() % 4 != 0) padded.push_back(0);
        literals = static_cast<std::uint32_t>(padded.size());
        std::vector<std::size_t> counts(256);
        for (const std::uint8_t literal : padded) ++counts[literal];
        const auto shares = FseFrequencies(counts, 1024);
        std::vector<FseEncoder> encoders(4, FseEncoder(shares, 1024));
        for (std::size_t i = padded.size(); i-- > 0;)
            encoders[i % 4].Encode(padded[i], literal_bits);
        for (std::size_t i = 0; i < 4; ++i) literal_states[i] = encoders[i].state();
        frequencies.insert(frequencies.end(), shares.begin(), shares.end());
    }

    void EncodeSteps(std::span<const CodedStep> coded) {
        steps = static_cast<std::uint32_t>(coded.size());
        FseEncoder l = Encoder(coded, &CodedStep::literals, 20, 64);
        FseEncoder m = Encoder(coded, &CodedStep::match, 20, 64);
        FseEncoder d = Encoder(coded, &CodedStep::distance, 64, 256);
        for (int i = 0; i < 8; ++i) step_bits.Push(0, 8);
        const auto push = [this](const Coded& number, FseEncoder& encoder) {
            step_bits.Push(number.above, number.bits);
            encoder.Encode(number.symbol, step_bits);
        };
        for (std::size_t i = coded.size(); i-- > 0;) {
            push(coded[i].distance, d);
            push(coded[i].match, m);
            push(coded[i].literals, l);
        }
        l_state = l.state();
        m_state = m.state();
        d_state = d.state();
    }

  private:
    FseEncoder Encoder(std::span<const CodedStep> coded, Coded CodedStep::*member,
                       std::size_t symbols, std::size_t states) {
        std::vector<std::size_t> counts(symbols);
        for (const CodedStep& step : coded) ++counts[(step.*member).symbol];
        const auto shares = FseFrequencies(counts, states);
        frequencies.insert(frequencies.end(), shares.begin(), shares.end());
        return FseEncoder(shares, states);
    }
};

void PutWideHeader(const FseBlock& block, Bytes& out) {
    const auto size = [](const BitWriter& bits) {
        return static_cast<std::uint32_t>(bits.bytes().size());
    };
    PutMagic(out, "bvx1");
    Put(out, block.bytes);
    Put(out, size(block.literal_bits) + size(block.step_bits));
    for (const std::uint32_t number :
         {block.literals, block.steps, size(block.literal_bits), size(block.step_bits)})
        Put(out, number);
    Put(out, static_cast<std::uint32_t>(-block.literal_bits.spare_bits()));
    for (const std::uint16_t state : block.literal_states) Put(out, state);
    Put(out, static_cast<std::uint32_t>(-block.step_bits.spare_bits()));
    for (const std::uint16_t state : {block.l_state, block.m_state, block.d_state}) Put(out, state);
    for (const std::uint16_t frequency : block.frequencies) Put(out, frequency);
    Put(out, std::uint16_t{0});  // as a C structure is padded
}

void PushFrequency(std::uint32_t f, BitWriter& bits) {
    if (f < 2) return bits.Push(f << 1, 2);
    if (f < 4) return bits.Push(1 | (f - 2) << 2, 3);
    if (f < 8) return bits.Push(3 | (f - 4) << 3, 5);
    if (f < 24) return bits.Push(7 | (f - 8) << 4, 8);
    bits.Push(15 | (f - 24) << 4, 14);
}

void PutPackedHeader(const FseBlock& block, Bytes& out) {
    BitWriter tables;
    for (const std::uint16_t frequency : block.frequencies) PushFrequency(frequency, tables);
    const auto spare = [](const BitWriter& bits) {
        return static_cast<std::uint64_t>(7 - bits.spare_bits());
    };
    const auto& states = block.literal_states;
    PutMagic(out, "bvx2");
    Put(out, block.bytes);
    Put(out, block.literals | std::uint64_t{block.literal_bits.bytes().size()} << 20 |
                 std::uint64_t{block.steps} << 40 | spare(block.literal_bits) << 60);
    Put(out, states[0] | std::uint64_t{states[1]} << 10 | std::uint64_t{states[2]} << 20 |
                 std::uint64_t{states[3]} << 30 |
                 std::uint64_t{block.step_bits.bytes().size()} << 40 |
                 spare(block.step_bits) << 60);
    Put(out, (32 + tables.bytes().size()) | std::uint64_t{block.l_state} << 32 |
                 std::uint64_t{block.m_state} << 42 | std::uint64_t{block.d_state} << 52);
    out.insert(out.end(), tables.bytes().begin(), tables.bytes().end());
}

void PutFse(std::span<const LzStep> steps, std::span<const std::uint8_t> literals,
            std::uint32_t size, bool packed, Bytes& out) {
    FseBlock block;
    block.bytes = size;
    block.EncodeSteps(CodeSteps(steps));
    block.EncodeLiterals(literals);
    packed ? PutPackedHeader(block, out) : PutWideHeader(block, out);
    for (const BitWriter* part : {&block.literal_bits, &block.step_bits})
        out.insert(out.end(), part->bytes().begin(), part->bytes().end());
}

void PutBlock(LzfseBlock kind, std::span<const LzStep> steps, std::span<const std::uint8_t> bytes,
              Bytes& out) {
    Bytes literals;
    std::size_t at = 0;
    for (const LzStep& step : steps) {
        const auto run = bytes.subspan(at, step.literals);
        literals.insert(literals.end(), run.begin(), run.end());
        at += step.literals + step.match;
    }
    const auto size = static_cast<std::uint32_t>(bytes.size());
    if (kind == LzfseBlock::kRaw) {
        PutMagic(out, "bvx-");
        Put(out, size);
        out.insert(out.end(), bytes.begin(), bytes.end());
    } else if (kind == LzfseBlock::kLzvn) {
        const Bytes payload = EncodeLzvn(steps, literals);
        PutMagic(out, "bvxn");
        Put(out, size);
        Put(out, static_cast<std::uint32_t>(payload.size()));
        out.insert(out.end(), payload.begin(), payload.end());
    } else {
        PutFse(steps, literals, size, kind == LzfseBlock::kPacked, out);
    }
}

}  // namespace

std::vector<std::uint8_t> EncodeLzfse(std::span<const std::uint8_t> bytes,
                                      const std::vector<LzfseBlock>& kinds,
                                      std::size_t most_steps) {
    constexpr std::size_t kMostLiterals = 30000;  // with those of the last step under 40000
    const bool lzvn = std::ranges::count(kinds, LzfseBlock::kLzvn) > 0;
    const std::vector<LzStep> steps = FindLzSteps(bytes, lzvn ? 65535 : 262139);
    Bytes out;
    std::size_t kind = 0;
    for (auto first = steps.begin(); first != steps.end();) {
        std::size_t size = 0, literals = 0;
        auto end = first;
        while (end != steps.end() && literals < kMostLiterals &&
               static_cast<std::size_t>(end - first) < most_steps) {
            size += end->literals + end->match;
            literals += (end++)->literals;
        }
        PutBlock(kinds[kind++ % kinds.size()], {first, end}, bytes.first(size), out);
        bytes = bytes.subspan(size);
        first = end;
    }
    PutMagic(out, "bvx$");
    return out;
}

}  // namespace tessera
