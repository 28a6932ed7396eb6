// The output of a Lempel-Ziv decoder: a fixed buffer that is filled from its start with literals
// and with copies of what it already holds. Nothing is read or written outside it.
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <span>

namespace tessera {

class LzOutput {
  public:
    explicit LzOutput(std::span<std::uint8_t> bytes) : bytes_(bytes) {}

    std::size_t written() const { return written_; }
    std::size_t room() const { return bytes_.size() - written_; }

    // Each is false, and writes nothing, if there is no room.
    bool Literal(std::uint8_t byte) {
        if (room() == 0) return false;
        bytes_[written_++] = byte;
        return true;
    }
    bool Literals(std::span<const std::uint8_t> bytes) {
        if (bytes.size() > room()) return false;
        if (!bytes.empty()) std::memcpy(bytes_.data() + written_, bytes.data(), bytes.size());
        written_ += bytes.size();
        return true;
    }
    // Repeats what begins `distance` bytes before the end. False also if that is before the start,
    // or if `distance` is 0.
    bool Match(std::size_t distance, std::size_t length) {
        if (distance == 0 || distance > written_ || length > room()) return false;
        std::uint8_t* to = bytes_.data() + written_;
        const std::uint8_t* from = to - distance;
        written_ += length;
        // Each round doubles what can be copied without overlap.
        for (std::size_t run = distance; length > 0; run *= 2) {
            const std::size_t count = std::min(run, length);
            std::memcpy(to, from, count);
            to += count;
            length -= count;
        }
        return true;
    }

  private:
    std::span<std::uint8_t> bytes_;
    std::size_t written_ = 0;
};

}  // namespace tessera
