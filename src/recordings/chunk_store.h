// The chunks of a bag or .mcap file: a part of the file as it is, or compressed. Reads either in
// the same way.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "core/input_file.h"
#include "recordings/ros_message.h"

namespace tessera {

enum class ChunkCompression { kNone, kBzip2, kLz4, kZstd };

// "none", "", "bz2", "lz4", "zstd".
std::optional<ChunkCompression> ChunkCompressionOf(std::string_view name);

struct Chunk {
    std::uint64_t offset = 0;  // of its data in the file
    std::uint64_t stored_bytes = 0;
    std::uint64_t bytes = 0;  // after decompression
    ChunkCompression compression = ChunkCompression::kNone;
};

// The chunk at `offset`, or else `whole`. `chunks` are in the file's order.
const Chunk& ChunkAt(const std::vector<Chunk>& chunks, std::uint64_t offset, const Chunk& whole);

// Keeps the last compressed chunk. Owner thread only. Errors do not name the file.
class ChunkStore {
  public:
    static constexpr std::uint64_t kMostChunkBytes = std::uint64_t{256} << 20;

    explicit ChunkStore(InputFile file) : file_(std::move(file)) {}

    const InputFile& file() const { return file_; }
    // Part of the chunk's data; an error if it is not all there.
    Status Read(const Chunk& chunk, std::uint64_t offset, std::span<std::uint8_t> bytes);

  private:
    Status Decompress(const Chunk& chunk);

    InputFile file_;
    std::uint64_t kept_offset_ = 0;  // of the decompressed chunk; 0: none
    std::vector<std::uint8_t> kept_, stored_;
};

}  // namespace tessera
