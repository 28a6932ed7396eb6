#include "recordings/lzfse.h"

#include "recordings/lzfse_block.h"
#include "recordings/lzvn.h"

namespace tessera {
namespace {

bool DecodeLzfsePayload(const LzfseHeader& header, std::span<const std::uint8_t> payload,
                        LzOutput& output) {
    switch (header.code) {
        case LzfseCode::kRaw: return output.Literals(payload);
        case LzfseCode::kLzvn: return DecodeLzvn(payload, output);
        case LzfseCode::kFse: return DecodeLzfseBlock(header.tables, payload, output);
        case LzfseCode::kEnd: break;
    }
    return false;
}

// Calls decode(header, payload) for each block until it returns false. True at the end mark.
template <typename Decode>
bool ForEachLzfseBlock(std::span<const std::uint8_t> stream, const Decode& decode) {
    while (const std::optional<LzfseHeader> header = ReadLzfseHeader(stream)) {
        if (header->code == LzfseCode::kEnd) return true;
        stream = stream.subspan(header->header_bytes);
        const auto payload_bytes = static_cast<std::size_t>(header->payload_bytes);
        if (!decode(*header, stream.first(payload_bytes))) return false;
        stream = stream.subspan(payload_bytes);
    }
    return false;
}

}  // namespace

bool DecodeLzfse(std::span<const std::uint8_t> stream, std::span<std::uint8_t> bytes) {
    LzOutput output(bytes);
    const bool good = ForEachLzfseBlock(stream, [&](const LzfseHeader& header, auto payload) {
        const std::uint64_t end = output.written() + std::uint64_t{header.bytes};
        return DecodeLzfsePayload(header, payload, output) && output.written() == end;
    });
    return good && output.room() == 0;
}

std::optional<std::uint64_t> LzfseSize(std::span<const std::uint8_t> stream) {
    std::uint64_t bytes = 0;
    const bool good = ForEachLzfseBlock(stream, [&](const LzfseHeader& header, auto) {
        bytes += header.bytes;
        return true;
    });
    return good ? std::optional(bytes) : std::nullopt;
}

}  // namespace tessera
