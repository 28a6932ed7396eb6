// The window's parts, each in a file of its own (panel_*.cpp). Inside an ImGui frame; they read and
// change the state.
#pragma once

#include <imgui.h>

#include "viz/gl_texture.h"
#include "viz/scene_view.h"
#include "viz/viewer_state.h"

namespace tessera {

void DrawStatusPanel(ViewerState& state, const SceneView& scene);  // inside the left column
void DrawControlsPanel(ViewerState& state);                        // inside the left column
// Inside the left column; a click looks at one.
void DrawObjectsPanel(ViewerState& state, SceneView& scene);
void DrawMessagesPanel(const ViewerState& state);  // the left column's rest
void DrawPlotsPanel(const ViewerState& state, const ControlRect& area);
// Over everything, while wanted.
void DrawHelp(ViewerState& state);
void DrawResetQuestion(ViewerState& state);

// Boxes that a detector gave, over a picture of the image at `from` to `to`.
void DrawDetections(const ViewerState& state, const ImVec2& from, const ImVec2& to);
// The objects' names over the 3D view, whose picture fills `area`.
void DrawObjectNames(const ViewerState& state, const SceneView& scene, const ControlRect& area);

// The 3D view and the pointer's work in it.
struct ViewPanelFrame {
    ControlRect area;
    bool may_redraw = true;
    bool smooth = false;
};
// True if the 3D view was drawn anew.
bool DrawViewPanel(ViewerState& state, SceneView& scene, const ViewPanelFrame& frame);

// Measured and predicted images. Made, used and destroyed with the OpenGL context current.
class ImagesPanel {
  public:
    void Draw(ViewerState& state, const ControlRect& area);

  private:
    void Update(const ViewerState& state);

    std::uint64_t taken_ = 0;
    GlTexture colour_, depth_, predicted_, residual_;
};

}  // namespace tessera
