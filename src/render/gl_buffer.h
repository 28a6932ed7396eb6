// A GPU buffer that grows and keeps its content. Create, use and destroy it with its OpenGL context
// current.
#pragma once

#include <cstddef>

namespace tessera {

class GlBuffer {
  public:
    GlBuffer() = default;
    ~GlBuffer();
    GlBuffer(const GlBuffer&) = delete;
    GlBuffer& operator=(const GlBuffer&) = delete;

    // Makes room for `bytes`; if the buffer must grow, for half as much again. Returns true if the
    // buffer has a new name; vertex arrays must then be updated.
    bool Reserve(std::size_t bytes);
    void Write(std::size_t offset, const void* data, std::size_t bytes);

    unsigned name() const { return name_; }
    std::size_t capacity() const { return capacity_; }  // bytes

  private:
    unsigned name_ = 0;
    std::size_t capacity_ = 0;
};

}  // namespace tessera
