#include "recordings/mkv_elements.h"

#include <algorithm>
#include <bit>

namespace tessera {
namespace {

constexpr std::uint32_t kMostMkvIdBytes = 4;

// How many bytes a number has that starts with this one; 9 if none does.
std::uint32_t MkvNumberBytes(std::uint8_t first) {
    return static_cast<std::uint32_t>(std::countl_zero(first)) + 1;
}

}  // namespace

std::optional<MkvNumber> ReadMkvNumber(MkvBytes bytes) {
    if (bytes.empty()) return std::nullopt;
    const std::uint32_t count = MkvNumberBytes(bytes[0]);
    if (count > 8 || count > bytes.size()) return std::nullopt;
    const std::uint64_t mask = (std::uint64_t{1} << (7 * count)) - 1;
    return MkvNumber{MkvUnsigned(bytes.first(count)) & mask, count};
}

std::optional<MkvElement> ReadMkvHead(MkvBytes bytes) {
    if (bytes.empty()) return std::nullopt;
    const std::uint32_t id_bytes = MkvNumberBytes(bytes[0]);
    if (id_bytes > kMostMkvIdBytes || id_bytes > bytes.size()) return std::nullopt;
    const std::optional<MkvNumber> size = ReadMkvNumber(bytes.subspan(id_bytes));
    if (!size) return std::nullopt;
    MkvElement element;
    element.id = static_cast<MkvId>(MkvUnsigned(bytes.first(id_bytes)));
    element.head_bytes = id_bytes + size->bytes;
    element.unknown_size = size->value == (std::uint64_t{1} << (7 * size->bytes)) - 1;
    element.bytes = element.unknown_size ? 0 : size->value;
    return element;
}

void ForEachMkvElement(MkvBytes content, const std::function<void(MkvId, MkvBytes)>& take) {
    while (const std::optional<MkvElement> element = ReadMkvHead(content)) {
        content = content.subspan(element->head_bytes);
        if (element->unknown_size || element->bytes > content.size()) return;
        const auto bytes = static_cast<std::size_t>(element->bytes);
        take(element->id, content.first(bytes));
        content = content.subspan(bytes);
    }
}

std::uint64_t MkvUnsigned(MkvBytes content) {
    if (content.size() > 8) return 0;
    std::uint64_t value = 0;
    for (const std::uint8_t byte : content) value = value << 8 | byte;
    return value;
}

std::string MkvText(MkvBytes content) { return {content.begin(), std::ranges::find(content, 0)}; }

}  // namespace tessera
