// The lines of the measurements in the 3D view. Made, used and destroyed with the OpenGL context
// current.
#pragma once

#include "viz/gl_lines.h"
#include "viz/viewer_state.h"

namespace tessera {

inline constexpr Rgb8 kMeasuredColour{255, 214, 92};

class MeasureLines {
  public:
    // Takes over what was measured since. True if anything changed.
    bool Update(const ViewerState& state);
    void Draw(const GlLineProgram& program, const GlLineProgram::View& view, float opacity);

  private:
    GlLines lines_;
    std::uint64_t taken_ = 0;
};

}  // namespace tessera
