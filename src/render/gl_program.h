// A shader program. Made, used and destroyed with its OpenGL context current.
#pragma once

#include <string>

#include "core/status.h"

namespace tessera {

class GlProgram {
  public:
    // Sources in GLSL 3.30. The error is the compiler's or linker's first line.
    static Result<GlProgram> Create(const char* vertex_source, const char* fragment_source);
    ~GlProgram();
    GlProgram(GlProgram&& other) noexcept : name_(other.name_) { other.name_ = 0; }
    GlProgram& operator=(GlProgram&&) = delete;

    void Use() const;
    // Of a uniform that the program uses.
    int Location(const char* uniform) const;

  private:
    explicit GlProgram(unsigned name) : name_(name) {}
    unsigned name_;
};

}  // namespace tessera
