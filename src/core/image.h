// A dense row-major image without padding. It owns its pixels. Pixel (0, 0) is the centre of the
// top-left pixel. Copies are deep, moves are cheap. Images never share storage, so passing them
// between threads is safe.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace tessera {

struct Rgb8 {
    std::uint8_t r = 0, g = 0, b = 0;
    bool operator==(const Rgb8&) const = default;
};

template <class T>
class Image {
  public:
    Image() = default;
    Image(int width, int height, T fill = T{})
        : width_(width),
          height_(height),
          pixels_(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), fill) {}

    int width() const { return width_; }
    int height() const { return height_; }
    bool empty() const { return pixels_.empty(); }
    std::size_t size() const { return pixels_.size(); }

    T* data() { return pixels_.data(); }
    const T* data() const { return pixels_.data(); }
    T* row(int y) { return pixels_.data() + Offset(0, y); }
    const T* row(int y) const { return pixels_.data() + Offset(0, y); }
    T& operator()(int x, int y) { return pixels_[Offset(x, y)]; }
    const T& operator()(int x, int y) const { return pixels_[Offset(x, y)]; }
    bool Contains(int x, int y) const { return x >= 0 && y >= 0 && x < width_ && y < height_; }

    // Changes the size. The pixel values are unspecified afterwards. Keeps the storage if it is
    // large enough.
    void Resize(int width, int height) {
        width_ = width;
        height_ = height;
        pixels_.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
    }

    bool operator==(const Image&) const = default;

  private:
    std::size_t Offset(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
               static_cast<std::size_t>(x);
    }

    int width_ = 0;
    int height_ = 0;
    std::vector<T> pixels_;
};

using ColourImage = Image<Rgb8>;
using DepthImage = Image<float>;  // metres along the optical axis; 0 means "no measurement"

}  // namespace tessera
