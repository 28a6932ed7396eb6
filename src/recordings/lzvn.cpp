#include "recordings/lzvn.h"

namespace tessera {
namespace {

// An opcode: first copy literals, which follow it, then a match.
struct LzvnOpcode {
    std::size_t bytes = 1;  // without its literals
    std::size_t literals = 0;
    std::size_t match = 0;
    bool end = false;
};

// The opcodes that have two bits of literals and three of match. All distances are kept for the
// next opcodes.
bool ReadLzvnPair(const std::uint8_t* code, std::size_t& distance, LzvnOpcode& op) {
    constexpr unsigned kEnd = 0x06, kNothing = 0x0e, kNothingEither = 0x16;
    const unsigned first = code[0];
    op.literals = first >> 6;
    op.match = (first >> 3 & 7) + 3;
    if ((first & 7) == 7) {  // LLMMM111, distance of 16 bits
        op.bytes = 3;
        distance = code[1] | std::size_t{code[2]} << 8;
    } else if ((first & 7) != 6) {  // LLMMMDDD DDDDDDDD
        op.bytes = 2;
        distance = (first & 7) << 8 | code[1];
    } else if (op.literals == 0) {  // 00xxx110
        op.match = 0;
        op.end = first == kEnd;
        op.bytes = op.end ? 8 : 1;
        return op.end || first == kNothing || first == kNothingEither;
    }  // otherwise LLMMM110, the distance of the match before
    return true;
}

// False: there is no such opcode. `code` has three readable bytes.
bool ReadLzvnOpcode(const std::uint8_t* code, std::size_t& distance, LzvnOpcode& op) {
    const unsigned first = code[0], high = first >> 4, low = first & 15;
    switch (high) {
        case 0xf:  // 1111MMMM, or 11110000 MMMMMMMM
            op.bytes = low == 0 ? 2 : 1;
            op.match = low == 0 ? code[1] + std::size_t{16} : low;
            return true;
        case 0xe:  // 1110LLLL, or 11100000 LLLLLLLL
            op.bytes = low == 0 ? 2 : 1;
            op.literals = low == 0 ? code[1] + std::size_t{16} : low;
            return true;
        case 0xa:
        case 0xb:  // 101LLMMM DDDDDDMM DDDDDDDD
            op.bytes = 3;
            op.literals = first >> 3 & 3;
            op.match = ((first & 7) << 2 | (code[1] & 3)) + 3;
            distance = code[1] >> 2 | std::size_t{code[2]} << 6;
            return true;
        case 0x7:
        case 0xd: return false;
        default: return ReadLzvnPair(code, distance, op);
    }
}

}  // namespace

bool DecodeLzvn(std::span<const std::uint8_t> payload, LzOutput& output) {
    std::size_t distance = 0;
    while (!payload.empty()) {
        std::uint8_t code[3] = {};
        std::memcpy(code, payload.data(), std::min(payload.size(), sizeof(code)));
        LzvnOpcode op;
        if (!ReadLzvnOpcode(code, distance, op)) return false;
        if (op.bytes + op.literals > payload.size()) return false;
        if (op.end) return op.bytes == payload.size();
        if (!output.Literals(payload.subspan(op.bytes, op.literals))) return false;
        if (op.match > 0 && !output.Match(distance, op.match)) return false;
        payload = payload.subspan(op.bytes + op.literals);
    }
    return false;
}

}  // namespace tessera
