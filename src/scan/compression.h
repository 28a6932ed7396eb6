// zstd, as far as scan files need it: the only place that knows the library.
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

    // Appends `content`, compressed by zstd's fast mode, to `out`.
    void Compress(std::span<const std::uint8_t> content, std::vector<std::uint8_t>& out);
    // Fills `content` exactly; false if the bytes are not what Compress makes of so many.
    bool Decompress(std::span<const std::uint8_t> bytes, std::span<std::uint8_t> content);
    // What the compressed bytes say that their content's size is; 0 if they say nothing sensible.
    static std::uint64_t ContentSize(std::span<const std::uint8_t> bytes);

  private:
    struct Contexts;
    std::unique_ptr<Contexts> contexts_;
};

}  // namespace tessera
