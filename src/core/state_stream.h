// Serialises the state of an object, so that it can resume in another process. Each class with such
// a state has
//     void SaveState(StateWriter&) const;   bool LoadState(StateReader&);
// A record that is only its fields can list them once, as a tuple of references (std::tie).
// Little endian, as on every machine this program runs on. Formats that must outlive a program
// version carry their own version number.
#pragma once

#include <Eigen/Geometry>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <optional>
#include <span>
#include <string>
#include <tuple>
#include <type_traits>
#include <vector>

namespace tessera {

static_assert(std::endian::native == std::endian::little);

template <class T>
concept PlainState = std::is_trivially_copyable_v<T> &&
    (std::is_arithmetic_v<T> || std::is_enum_v<T>);

// Appends to a vector, which must outlive the writer.
class StateWriter {
  public:
    explicit StateWriter(std::vector<std::uint8_t>& bytes) : bytes_(bytes) {}

    template <PlainState T>
    void Put(T value) {
        Append(&value, sizeof(T));
    }
    void Put(const Eigen::Isometry3d& T) { Append(T.matrix().data(), 16 * sizeof(double)); }
    template <class S, int R, int C>
    void Put(const Eigen::Matrix<S, R, C>& m) {
        static_assert(R > 0 && C > 0);
        Append(m.data(), sizeof(S) * R * C);
    }
    // T must contain neither padding nor pointers.
    template <class T>
    void PutArray(std::span<const T> values) {
        static_assert(std::is_trivially_copyable_v<T>);
        Put(static_cast<std::uint64_t>(values.size()));
        Append(values.data(), values.size_bytes());
    }
    void Put(const std::string& text) { PutArray(std::span<const char>(text)); }
    template <class T>
    void Put(const std::vector<T>& values) {
        PutArray(std::span<const T>(values));
    }
    template <class T>
    void Put(const std::optional<T>& value) {
        Put(value.has_value());
        if (value) Put(*value);
    }
    template <class... T>
    void Put(const std::tuple<T&...>& fields) {
        std::apply([this](const auto&... field) { (this->Put(field), ...); }, fields);
    }

  private:
    void Append(const void* data, std::size_t size);

    std::vector<std::uint8_t>& bytes_;
};

// Reads what a StateWriter wrote. If too few bytes are left or a value is invalid (a non-rigid
// pose, a non-finite matrix, a bool other than 0 or 1), Get returns false, and so does every later
// Get. A size in the data never makes it allocate more than the bytes that are left.
class StateReader {
  public:
    explicit StateReader(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

    template <PlainState T>
    bool Get(T& value) {
        if constexpr (std::is_same_v<T, bool>) {
            std::uint8_t byte = 0;
            if (!Take(&byte, 1) || byte > 1) return Fail();
            value = byte != 0;
            return true;
        } else {
            return Take(&value, sizeof(T));
        }
    }
    bool Get(Eigen::Isometry3d& T) {
        if (!Take(T.matrix().data(), 16 * sizeof(double))) return false;
        const bool rigid =
            T.matrix().allFinite() && T.matrix().row(3) == Eigen::RowVector4d(0, 0, 0, 1) &&
            (T.linear() * T.linear().transpose() - Eigen::Matrix3d::Identity()).norm() < 1e-3 &&
            T.linear().determinant() > 0;
        return rigid || Fail();
    }
    template <class S, int R, int C>
    bool Get(Eigen::Matrix<S, R, C>& m) {
        return Take(m.data(), sizeof(S) * R * C) && (m.allFinite() || Fail());
    }
    template <class T>
    bool GetArray(std::vector<T>& values) {
        std::uint64_t count = 0;
        if (!Get(count) || count > (bytes_.size() - at_) / sizeof(T)) return Fail();
        values.resize(static_cast<std::size_t>(count));
        return Take(values.data(), values.size() * sizeof(T));
    }
    bool Get(std::string& text) {
        std::vector<char> letters;
        if (!GetArray(letters)) return false;
        text.assign(letters.begin(), letters.end());
        return true;
    }
    template <class T>
    bool Get(std::optional<T>& value) {
        bool there = false;
        value.reset();
        if (!Get(there)) return false;
        return !there || Get(value.emplace());
    }
    template <class T>
    bool Get(std::vector<T>& values) {
        return GetArray(values);
    }
    template <class... T>
    bool Get(const std::tuple<T&...>& fields) {
        return std::apply([this](auto&... field) { return (this->Get(field) && ...); }, fields);
    }

    bool ok() const { return !failed_; }
    bool at_end() const { return ok() && at_ == bytes_.size(); }

  private:
    bool Fail() {
        failed_ = true;
        return false;
    }
    bool Take(void* data, std::size_t size) {
        if (failed_ || size > bytes_.size() - at_) return Fail();
        if (size > 0) std::memcpy(data, bytes_.data() + at_, size);
        at_ += size;
        return true;
    }

    std::span<const std::uint8_t> bytes_;
    std::size_t at_ = 0;
    bool failed_ = false;
};

// What a StateWriter makes of the fields.
template <class... T>
std::vector<std::uint8_t> Encoded(const std::tuple<T&...>& fields) {
    std::vector<std::uint8_t> bytes;
    StateWriter(bytes).Put(fields);
    return bytes;
}

// Whether all floats and doubles among the fields are finite.
template <class... T>
bool AllFinite(const std::tuple<T&...>& fields) {
    const auto finite = [](const auto& field) {
        if constexpr (std::is_floating_point_v<std::remove_cvref_t<decltype(field)>>)
            return std::isfinite(field);
        else
            return true;
    };
    return std::apply([&](const auto&... field) { return (finite(field) && ...); }, fields);
}

}  // namespace tessera
