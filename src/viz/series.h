// The most recent values of one quantity, for a rolling plot. Owner thread only.
#pragma once

#include <cstddef>
#include <vector>

namespace tessera {

class Series {
  public:
    // Keeps the newest `capacity` values, at least one.
    explicit Series(std::size_t capacity = 240) : values_(capacity) {}

    void Add(float value);
    void Clear() { size_ = next_ = 0; }

    std::size_t size() const { return size_; }
    std::size_t capacity() const { return values_.size(); }
    float operator[](std::size_t i) const;  // oldest first
    float last() const { return size_ == 0 ? 0 : (*this)[size_ - 1]; }
    float max() const;  // 0 if empty or if all values are negative

  private:
    std::vector<float> values_;
    std::size_t size_ = 0, next_ = 0;
};

// The smallest value of 1, 2, 5, 10, 20, ... times a power of ten that is not below `value`; the
// end of a plot's axis.
float AxisEnd(float value);

}  // namespace tessera
