// Reads the numbers in a PLY file's body one after another, from text or binary. Used by
// mesh_io.cpp only. After the end of the file or a malformed number, both readers return 0 and ok()
// is false.
#pragma once

#include <algorithm>
#include <bit>
#include <charconv>
#include <cstdint>
#include <cstring>
#include <string_view>

#include "io/ply_header.h"

namespace tessera {

class BinaryScalars {
  public:
    BinaryScalars(std::string_view body, bool little_endian)
        : rest_(body), swap_(little_endian != (std::endian::native == std::endian::little)) {}

    bool ok() const { return ok_; }

    double Read(PlyType type) {
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
        const std::size_t bytes = PlyTypeBytes(type);
        ok_ = ok_ && count <= rest_.size() / bytes;
        if (ok_) rest_.remove_prefix(count * bytes);
    }

  private:
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
    bool swap_;
    bool ok_ = true;
};

class TextScalars {
  public:
    explicit TextScalars(std::string_view body) : next_(body.data()), end_(next_ + body.size()) {}

    bool ok() const { return ok_; }

    double Read(PlyType) {
        while (next_ != end_ && IsSpace(*next_)) ++next_;
        if (next_ != end_ && *next_ == '+') ++next_;
        double value = 0;
        const auto [after, error] = std::from_chars(next_, end_, value);
        ok_ = ok_ && error == std::errc() && (after == end_ || IsSpace(*after));
        next_ = after;
        return ok_ ? value : 0;
    }

    std::uint64_t ReadCount(PlyType type) {
        const double count = Read(type);
        if (!(count >= 0 && count < 4294967296.0)) ok_ = false;
        return ok_ ? static_cast<std::uint64_t>(count) : 0;
    }

    void Skip(PlyType type, std::uint64_t count) {
        for (std::uint64_t i = 0; i < count && ok_; ++i) Read(type);
    }

  private:
    static bool IsSpace(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; }

    const char* next_;
    const char* end_;
    bool ok_ = true;
};

}  // namespace tessera
