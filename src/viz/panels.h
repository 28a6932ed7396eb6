// The panels of the window, each in its own file (panel_*.cpp). Call inside an ImGui frame. They
// read and change the state.
#pragma once

#include <imgui.h>

#include "viz/gl_texture.h"
#include "viz/scan_hints.h"
#include "viz/scene_view.h"
#include "viz/viewer_state.h"

namespace tessera {

void DrawStatusPanel(ViewerState& state, const SceneView& scene);  // inside the left column
void DrawControlsPanel(ViewerState& state);                        // inside the left column
void DrawDetectorPanel(ViewerState& state);                        // inside the left column
// Inside the left column; a click centres the view on an object.
void DrawObjectsPanel(ViewerState& state, SceneView& scene);
void DrawMessagesPanel(const ViewerState& state);  // rest of the left column
// The newest message over the 3D view, which fills `area`, between what stands at its sides.
void DrawNote(ViewerState& state, const ControlRect& area, float inset_width);
void DrawPlotsPanel(const ViewerState& state, const ControlRect& area);
// Drawn over everything, while active.
void DrawHelp(ViewerState& state);
void DrawResetQuestion(ViewerState& state);

// Draws the newest detections over the image shown from `from` to `to`.
void DrawDetections(const ViewerState& state, const ImVec2& from, const ImVec2& to);
// Draws the object names over the 3D view, which fills `area`.
void DrawObjectNames(const ViewerState& state, const SceneView& scene, const ControlRect& area);

// Drawn over the 3D view, which fills `area`: the buttons of the expert window; the legends and the
// scale bar, which ends at `right`.
void DrawToolbar(ViewerState& state, const ControlRect& area);
void DrawOverlays(ViewerState& state, SceneView& scene, const ControlRect& area, float right);

// Measuring: true if a click on the view, the item that ImGui drew last, became a corner; the
// figures beside the lines; the tool's part of the panel. All over the 3D view in `area`.
// `pixel`: of the 3D view's picture, under the mouse.
bool ClickToMeasure(ViewerState& state, const SceneView& scene, const ControlRect& area,
                    const Eigen::Vector2i& pixel);
void DrawMeasurements(const ViewerState& state, const SceneView& scene, const ControlRect& area);
void DrawMeasureTool(ViewerState& state);
// The panel of the tools that are on.
void DrawTools(ViewerState& state, SceneView& scene, const ControlRect& area);

// What the camera sees, in the lower right corner of the 3D view, and the width to keep free for
// it: 0 without an image, or while it is hidden.
float InsetWidth(const ViewerState& state, const GlTexture& image, const ControlRect& view);
void DrawInset(ViewerState& state, const GlTexture& image, const ControlRect& view);

// The 3D view and its mouse control.
struct ViewPanelFrame {
    ControlRect area;
    float inset_width = 0;  // kept free at the right edge of its lower end
    bool may_redraw = true;
    bool smooth = false;
};
// True if the 3D view was redrawn.
bool DrawViewPanel(ViewerState& state, SceneView& scene, const ViewPanelFrame& frame);

// The scan view around the 3D view. Made, used and destroyed with the OpenGL context current.
class ScanPanel {
  public:
    struct Layout {
        ControlRect strip, view, bar;
    };
    static Layout LayOut(float width, float height);

    // Takes a new image, if there is one. Call before the others in each frame.
    void Update(const ViewerState& state);
    // What the camera's image needs at the right edge of the 3D view; 0 while it is hidden.
    float inset_width(const ViewerState& state, const ControlRect& view) const;
    void Draw(ViewerState& state, const SceneView& scene, const Layout& layout);

  private:
    std::optional<ScanHint> Hint(const ViewerState& state, const SceneView& scene) const;

    std::uint64_t taken_ = 0;
    GlTexture colour_;
    DepthShares depth_;
    HintHolder holder_;
};

// The time line of a finished run, with the figures and the image of its frame. Made, used and
// destroyed with the OpenGL context current.
class TimeLinePanel {
  public:
    // `open`: the run's source; empty: no images.
    void Begin(FrameImages::Open open);
    // Asks for the frame's image and takes one that has come. True if it has.
    bool Update(const ViewerState& state);
    static float Height();
    float inset_width(const ViewerState& state, const ControlRect& view) const {
        return InsetWidth(state, shown(state), view);
    }
    // `view`: the area of the 3D view, in which the image stands.
    void Draw(ViewerState& state, const SceneView& scene, const ControlRect& area,
              const ControlRect& view);

  private:
    const GlTexture& shown(const ViewerState& state) const;

    std::optional<FrameImages> images_;
    std::int64_t asked_ = -1, has_ = -1;
    GlTexture colour_, none_;
};

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
