// A buffer on the graphics card that grows and keeps its content. Made, used and destroyed with its
// OpenGL context current.
#pragma once

#include <cstddef>

namespace tessera {

class GlBuffer {
  public:
    GlBuffer() = default;
    ~GlBuffer();
    GlBuffer(const GlBuffer&) = delete;
    GlBuffer& operator=(const GlBuffer&) = delete;

    // Makes room for `bytes` and half as much again. True if the buffer has a new name, which
    // vertex arrays must be told.
    bool Reserve(std::size_t bytes);
    void Write(std::size_t offset, const void* data, std::size_t bytes);

    unsigned name() const { return name_; }
    std::size_t capacity() const { return capacity_; }  // bytes

  private:
    unsigned name_ = 0;
    std::size_t capacity_ = 0;
};

}  // namespace tessera
