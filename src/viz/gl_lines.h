// 3D lines of any width, which OpenGL's core profile lacks. Each line is drawn as a screen-facing
// rectangle. Made, used and destroyed with the OpenGL context current.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <span>

#include "core/status.h"
#include "render/gl_buffer.h"
#include "render/gl_program.h"

namespace tessera {

struct LineVertex {
    std::array<float, 3> position_m;     // world frame
    std::array<std::uint8_t, 4> colour;  // a = 0: no line starts or ends here
};

// The vertices of one set of lines in GPU memory.
class GlLines {
  public:
    GlLines();
    ~GlLines();
    GlLines(const GlLines&) = delete;
    GlLines& operator=(const GlLines&) = delete;

    void Clear() { count_ = 0; }
    void Append(std::span<const LineVertex> vertices);
    std::size_t size() const { return count_; }

  private:
    friend class GlLineProgram;
    void Bind(bool connected);

    GlBuffer buffer_;
    std::size_t count_ = 0;
    unsigned vertex_array_ = 0;
};

class GlLineProgram {
  public:
    static Result<GlLineProgram> Create();

    struct View {
        Eigen::Matrix4d clip_from_world;
        int width_px = 0, height_px = 0;
    };
    // Draws lines from each vertex to the next (`connected`), or between vertices 1 and 2, 3 and 4
    // and so on. `opacity` in [0, 1]. The caller sets depth test and blending.
    void Draw(GlLines& lines, const View& view, bool connected, float width_px,
              float opacity) const;

  private:
    explicit GlLineProgram(GlProgram program) : program_(std::move(program)) {}
    GlProgram program_;
};

}  // namespace tessera
