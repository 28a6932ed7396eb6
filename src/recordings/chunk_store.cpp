#include "recordings/chunk_store.h"

#include <bzlib.h>
#include <lz4frame.h>
#include <zstd.h>

#include <algorithm>
#include <cstring>
#include <memory>

namespace tessera {
namespace {

using ByteSpan = std::span<std::uint8_t>;

bool FromBzip2(ByteView stored, ByteSpan out) {
    auto size = static_cast<unsigned>(out.size());
    auto* source = reinterpret_cast<char*>(const_cast<std::uint8_t*>(stored.data()));
    return BZ2_bzBuffToBuffDecompress(reinterpret_cast<char*>(out.data()), &size, source,
                                      static_cast<unsigned>(stored.size()), 0, 0) == BZ_OK &&
           size == out.size();
}

bool FromLz4(ByteView stored, ByteSpan out) {
    LZ4F_dctx* context = nullptr;
    if (LZ4F_isError(LZ4F_createDecompressionContext(&context, LZ4F_VERSION))) return false;
    const std::unique_ptr<LZ4F_dctx, decltype(&LZ4F_freeDecompressionContext)> owner(
        context, &LZ4F_freeDecompressionContext);
    std::size_t read = 0, written = 0;
    while (written < out.size() && read < stored.size()) {
        std::size_t room = out.size() - written, there = stored.size() - read;
        const std::size_t state = LZ4F_decompress(context, out.data() + written, &room,
                                                  stored.data() + read, &there, nullptr);
        if (LZ4F_isError(state) || (room == 0 && there == 0)) return false;
        written += room;
        read += there;
        if (state == 0) break;
    }
    return written == out.size();
}

bool FromZstd(ByteView stored, ByteSpan out) {
    return ZSTD_decompress(out.data(), out.size(), stored.data(), stored.size()) == out.size();
}

}  // namespace

std::optional<ChunkCompression> ChunkCompressionOf(std::string_view name) {
    if (name.empty() || name == "none") return ChunkCompression::kNone;
    if (name == "bz2") return ChunkCompression::kBzip2;
    if (name == "lz4") return ChunkCompression::kLz4;
    if (name == "zstd") return ChunkCompression::kZstd;
    return std::nullopt;
}

const Chunk& ChunkAt(const std::vector<Chunk>& chunks, std::uint64_t offset, const Chunk& whole) {
    const auto found = std::ranges::lower_bound(chunks, offset, {}, &Chunk::offset);
    return found == chunks.end() || found->offset != offset ? whole : *found;
}

Status ChunkStore::Read(const Chunk& chunk, std::uint64_t offset, ByteSpan bytes) {
    if (offset > chunk.bytes || bytes.size() > chunk.bytes - offset)
        return Status::Error("a record is longer than its chunk");
    if (bytes.empty()) return {};
    if (chunk.compression == ChunkCompression::kNone)
        return file_.ReadAt(chunk.offset + offset, bytes);
    if (Status status = Decompress(chunk); !status.ok()) return status;
    std::memcpy(bytes.data(), kept_.data() + offset, bytes.size());
    return {};
}

Status ChunkStore::Decompress(const Chunk& chunk) {
    if (kept_offset_ == chunk.offset) return {};
    kept_offset_ = 0;
    if (chunk.bytes > kMostChunkBytes || chunk.stored_bytes > kMostChunkBytes)
        return Status::Error("a chunk of more than 256 MB");
    stored_.resize(static_cast<std::size_t>(chunk.stored_bytes));
    if (Status status = file_.ReadAt(chunk.offset, stored_); !status.ok()) return status;
    kept_.resize(static_cast<std::size_t>(chunk.bytes));
    const bool good = chunk.compression == ChunkCompression::kBzip2 ? FromBzip2(stored_, kept_)
                      : chunk.compression == ChunkCompression::kLz4 ? FromLz4(stored_, kept_)
                                                                    : FromZstd(stored_, kept_);
    if (!good) return Status::Error("a chunk is damaged");
    kept_offset_ = chunk.offset;
    return {};
}

}  // namespace tessera
