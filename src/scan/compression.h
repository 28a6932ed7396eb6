// Wrapper for the parts of zstd that scan files need. Only its source uses the library.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace tessera {

// Keeps its working memory between calls. Owner thread only.
class Compressor {
  public:
    Compressor();
    ~Compressor();
    Compressor(const Compressor&) = delete;
    Compressor& operator=(const Compressor&) = delete;

    // Appends `content`, compressed with zstd's fast mode, to `out`.
    void Compress(std::span<const std::uint8_t> content, std::vector<std::uint8_t>& out);
    // Returns false if the bytes are damaged or do not decompress to exactly the size of `content`.
    bool Decompress(std::span<const std::uint8_t> bytes, std::span<std::uint8_t> content);
    // The content size that the compressed bytes declare; 0 if they declare none or it is invalid.
    static std::uint64_t ContentSize(std::span<const std::uint8_t> bytes);

  private:
    struct Contexts;
    std::unique_ptr<Contexts> contexts_;
};

}  // namespace tessera
