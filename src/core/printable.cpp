#include "core/printable.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>

namespace tessera {
namespace {

std::uint8_t ByteAt(std::string_view text, std::size_t i) {
    return i < text.size() ? static_cast<std::uint8_t>(text[i]) : std::uint8_t{0};
}

// Length of the valid UTF-8 character at the text's begin, and its code point; 0 if there is none.
std::size_t FirstCharacter(std::string_view text, std::uint32_t& code) {
    const std::uint32_t lead = ByteAt(text, 0);
    const std::size_t length = lead < 0x80    ? 1
                               : lead < 0xc2  ? 0
                               : lead < 0xe0  ? 2
                               : lead < 0xf0  ? 3
                               : lead <= 0xf4 ? 4
                                              : 0;
    constexpr std::uint32_t kLeadMask[] = {0, 0x7f, 0x1f, 0x0f, 0x07};
    code = lead & kLeadMask[length];
    for (std::size_t i = 1; i < length; ++i) {
        const std::uint32_t next = ByteAt(text, i);
        if ((next & 0xc0) != 0x80) return 0;
        code = code << 6 | (next & 0x3f);
    }
    // Longer than needed, a surrogate, or beyond Unicode.
    constexpr std::uint32_t kLeast[] = {0, 0, 0x80, 0x800, 0x10000};
    const bool valid =
        code >= kLeast[length] && !(code >= 0xd800 && code < 0xe000) && code <= 0x10ffff;
    return valid ? length : 0;
}

bool IsShown(std::uint32_t code) {
    const bool control = code < 0x20 || (code >= 0x7f && code < 0xa0);
    // Marks, embeddings and isolates that change the direction of writing, and line separators.
    const bool turns = code == 0x61c || (code >= 0x200b && code <= 0x200f) ||
                       (code >= 0x2028 && code <= 0x202e) || (code >= 0x2066 && code <= 0x2069) ||
                       code == 0xfeff;
    return !control && !turns;
}

}  // namespace

std::string Printable(std::string_view text, std::size_t most_bytes) {
    std::string shown;
    while (!text.empty()) {
        std::uint32_t code = 0;
        const std::size_t length = FirstCharacter(text, code);
        const bool as_it_is = length > 0 && IsShown(code);
        const std::size_t taken = std::max<std::size_t>(length, 1);
        std::string piece;
        for (std::size_t i = 0; i < taken; ++i)
            piece += as_it_is ? std::string(1, text[i]) : fmt::format("\\x{:02x}", ByteAt(text, i));
        if (shown.size() + piece.size() > most_bytes) return shown + "...";
        shown += piece;
        text.remove_prefix(taken);
    }
    return shown;
}

std::string ShellLine(const std::vector<std::string>& words) {
    constexpr std::string_view kPlain =
        "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_./:=,+-@%";
    std::string line;
    for (const std::string& word : words) {
        if (!line.empty()) line += ' ';
        if (!word.empty() && word.find_first_not_of(kPlain) == std::string::npos) {
            line += word;
            continue;
        }
        line += '\'';
        for (const char c : word) line += c == '\'' ? std::string("'\\''") : std::string(1, c);
        line += '\'';
    }
    return line;
}

}  // namespace tessera
