// The panels of the window, each in its own file (panel_*.cpp). Call inside an ImGui frame. They
// read and change the state.
#pragma once

#include <imgui.h>

#include "viz/gl_texture.h"
#include "viz/scene_view.h"
#include "viz/viewer_state.h"

namespace tessera {

void DrawStatusPanel(ViewerState& state, const SceneView& scene);  // inside the left column
void DrawControlsPanel(ViewerState& state);                        // inside the left column
// Inside the left column; a click centres the view on an object.
void DrawObjectsPanel(ViewerState& state, SceneView& scene);
void DrawMessagesPanel(const ViewerState& state);  // rest of the left column
void DrawPlotsPanel(const ViewerState& state, const ControlRect& area);
// Drawn over everything, while active.
void DrawHelp(ViewerState& state);
void DrawResetQuestion(ViewerState& state);

// Draws the newest detections over the image shown from `from` to `to`.
void DrawDetections(const ViewerState& state, const ImVec2& from, const ImVec2& to);
// Draws the object names over the 3D view, which fills `area`.
void DrawObjectNames(const ViewerState& state, const SceneView& scene, const ControlRect& area);

// The 3D view and its mouse control.
struct ViewPanelFrame {
    ControlRect area;
    bool may_redraw = true;
    bool smooth = false;
};
// True if the 3D view was redrawn.
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
