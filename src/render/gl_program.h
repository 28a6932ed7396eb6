// A shader program. Create, use and destroy it with its OpenGL context current.
#pragma once

#include <string>

#include "core/status.h"

namespace tessera {

class GlProgram {
  public:
    // Takes GLSL 3.30 sources. The error is the first line of the compiler's or linker's log.
    static Result<GlProgram> Create(const char* vertex_source, const char* fragment_source);
    ~GlProgram();
    GlProgram(GlProgram&& other) noexcept : name_(other.name_) { other.name_ = 0; }
    GlProgram& operator=(GlProgram&&) = delete;

    void Use() const;
    // The location of a uniform. The program must use it.
    int Location(const char* uniform) const;

  private:
    explicit GlProgram(unsigned name) : name_(name) {}
    unsigned name_;
};

}  // namespace tessera
