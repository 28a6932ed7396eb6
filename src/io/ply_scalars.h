// Reads the numbers in a PLY file's body one after another, from text or binary. Used by
// mesh_io.cpp only.
#pragma once

#include <algorithm>
#include <bit>
#include <charconv>
#include <cstdint>
#include <cstring>
#include <string_view>

#include "io/ply_header.h"

namespace tessera {

// After the end of the file or a malformed number, Read returns 0 and ok() is false.
class PlyScalars {
  public:
    PlyScalars(std::string_view body, PlyFormat format)
        : rest_(body),
          text_(format == PlyFormat::kAscii),
          swap_((format == PlyFormat::kLittleEndian) !=
                (std::endian::native == std::endian::little)) {}

    bool ok() const { return ok_; }

    double Read(PlyType type) {
        if (text_) return ReadText();
        switch (type) {
            case PlyType::kInt8: return ReadAs<std::int8_t>();
            case PlyType::kUint8: return ReadAs<std::uint8_t>();
            case PlyType::kInt16: return ReadAs<std::int16_t>();
            case PlyType::kUint16: return ReadAs<std::uint16_t>();
            case PlyType::kInt32: return ReadAs<std::int32_t>();
            case PlyType::kUint32: return ReadAs<std::uint32_t>();
            case PlyType::kFloat32: return static_cast<double>(ReadAs<float>());
            case PlyType::kFloat64: return ReadAs<double>();
        }
        return 0;
    }

    // Reads a list's length, a non-negative integer.
    std::uint64_t ReadCount(PlyType type) {
        const double count = Read(type);
        if (!(count >= 0 && count < 4294967296.0)) ok_ = false;
        return ok_ ? static_cast<std::uint64_t>(count) : 0;
    }

    void Skip(PlyType type, std::uint64_t count) {
        if (text_) {
            for (std::uint64_t i = 0; i < count && ok_; ++i) ReadText();
            return;
        }
        const std::size_t bytes = PlyTypeBytes(type);
        ok_ = ok_ && count <= rest_.size() / bytes;
        if (ok_) rest_.remove_prefix(count * bytes);
    }

  private:
    double ReadText() {
        while (!rest_.empty() && IsSpace(rest_.front())) rest_.remove_prefix(1);
        if (rest_.starts_with('+')) rest_.remove_prefix(1);
        const char* const end = rest_.data() + rest_.size();
        double value = 0;
        const auto [after, error] = std::from_chars(rest_.data(), end, value);
        ok_ = ok_ && error == std::errc() && (after == end || IsSpace(*after));
        rest_.remove_prefix(static_cast<std::size_t>(after - rest_.data()));
        return ok_ ? value : 0;
    }

    static bool IsSpace(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; }

    template <class T>
    T ReadAs() {
        char bytes[sizeof(T)];
        if (!ok_ || rest_.size() < sizeof(T)) {
            ok_ = false;
            return T{};
        }
        std::memcpy(bytes, rest_.data(), sizeof(T));
        rest_.remove_prefix(sizeof(T));
        if (swap_) std::reverse(bytes, bytes + sizeof(T));
        T value;
        std::memcpy(&value, bytes, sizeof(T));
        return value;
    }

    std::string_view rest_;
    bool text_, swap_;
    bool ok_ = true;
};

}  // namespace tessera
