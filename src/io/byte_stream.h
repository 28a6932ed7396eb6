// Bytes that arrive from another program: standard input, or the sender at a Unix socket.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/status.h"

namespace tessera {

// Owner thread only.
class ByteStream {
  public:
    enum class Got {
        kAll,   // the bytes asked for are there
        kWait,  // not yet; ask again for the same
        kEnd,   // the sender is gone, or there is none yet
    };

    // "-": standard input. Else a socket is made at this path, and the newest sender that connects
    // is read. The error names the path.
    static Result<ByteStream> Open(const std::string& path);
    // Takes over an open file.
    explicit ByteStream(int file) : file_(file) {}
    ~ByteStream();
    ByteStream(ByteStream&& other) noexcept;
    ByteStream& operator=(ByteStream&&) = delete;

    // Waits a third of a second at most. After kAll, `bytes` are the next `count` bytes.
    Got Read(std::size_t count, std::vector<std::uint8_t>& bytes);
    // After kEnd: whether another sender may come. Forgets bytes that were not asked for in full.
    bool WaitsForSender();
    // Whether part of what was asked for has arrived.
    bool partly() const { return filled_ > 0; }

  private:
    ByteStream() = default;
    bool WaitReadable(int file, int most_ms) const;

    std::string path_;   // of the socket that is ours to remove
    int listener_ = -1;  // -1: there is only one sender
    int file_ = -1;      // -1: no sender
    std::size_t filled_ = 0;
};

}  // namespace tessera
