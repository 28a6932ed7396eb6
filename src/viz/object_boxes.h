// Oriented boxes of the objects in the 3D view. Made, used and destroyed with the OpenGL context
// current.
#pragma once

#include "viz/gl_lines.h"
#include "viz/viewer_state.h"

namespace tessera {

class ObjectBoxes {
  public:
    // Takes over new objects and the selection. True if anything changed.
    bool Update(const ViewerState& state);
    void Draw(const GlLineProgram& program, const GlLineProgram::View& view, float opacity);

  private:
    GlLines edges_, selected_;
    std::uint64_t taken_ = 0;
    int selected_id_ = 0;
};

}  // namespace tessera
