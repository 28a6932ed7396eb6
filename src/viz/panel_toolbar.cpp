// The buttons over the 3D view of the expert window.
#include "viz/panels.h"
#include "viz/widgets.h"

namespace tessera {
namespace {

struct ShadingText {
    Shading shading;
    const char *label, *tip;
};
constexpr ShadingText kShadingTexts[] = {
    {Shading::kColour, "Colour", "The scene's own colours  (C: the next shading)"},
    {Shading::kLabel, "Objects", "By the kind of object; grey where there is none"},
    {Shading::kCoverage, "Coverage", "Own colours where well measured, orange thin, red seen once"},
    {Shading::kWeight, "Weight", "How well each place is measured, on a scale"},
    {Shading::kGrey, "Grey", "The shape alone"},
    {Shading::kNormal, "Normals", "The direction that each surface faces"},
};
static_assert(std::size(kShadingTexts) == kShadings);

// Places buttons in a row, and below it what finds no room.
class ButtonRow {
  public:
    ButtonRow(Controls& controls, const ControlRect& area)
        : controls_(controls),
          left_(area.x + Scaled(10)),
          right_(area.x + area.width - Scaled(10)),
          x_(left_),
          y_(area.y + Scaled(10)) {}

    bool Button(const char* name, const char* label, bool lit, const char* tip) {
        const float padding = 2 * ImGui::GetStyle().FramePadding.x, gap = Scaled(4);
        const float width = ImGui::CalcTextSize(label).x + padding;
        if (x_ > left_ && x_ + width > right_) {
            x_ = left_;
            y_ += ImGui::GetFrameHeight() + gap;
        }
        ImGui::SetCursorScreenPos({x_, y_});
        const bool pressed = MarkedButton(controls_, name, label, width, lit);
        Tip(tip);
        x_ += width + gap;
        return pressed;
    }
    void Gap() { x_ += Scaled(8); }

  private:
    Controls& controls_;
    float left_, right_, x_, y_;
};

void DrawShadings(ViewerState& state, ButtonRow& row) {
    for (const ShadingText& text : kShadingTexts) {
        if (!state.CanShade(text.shading)) continue;
        const std::string name = std::string("shading.") + ToString(text.shading);
        if (row.Button(name.c_str(), text.label, state.view.shading == text.shading, text.tip))
            state.view.shading = text.shading;
    }
}

}  // namespace

void DrawToolbar(ViewerState& state, const ControlRect& area) {
    ViewChoices& view = state.view;
    ImGui::PushFont(SmallFont());
    ButtonRow row(state.controls, area);
    DrawShadings(state, row);
    row.Gap();
    if (row.Button("wireframe", "Wireframe", view.wireframe,
                   "Only the edges of the triangles  (W)"))
        view.wireframe = !view.wireframe;
    if (row.Button("depth_test", "See through", !view.depth_test,
                   "Surfaces no longer hide what is behind them  (D)"))
        view.depth_test = !view.depth_test;
    if (state.labelled() &&
        row.Button("objects", "Boxes", view.show_objects, "Boxes and names of the objects  (B)"))
        view.show_objects = !view.show_objects;
    if (state.link && row.Button("truth", "True path", view.show_truth,
                                 "The path as the recording gives it, in white  (T)"))
        view.show_truth = !view.show_truth;
    row.Gap();
    if (state.can_measure() && row.Button("measure", "Measure", state.measuring.on(),
                                          "Lengths, angles, areas and volumes by clicks  (L)"))
        state.ToggleMeasuring();
    if (row.Button("cut", "Cut", view.cut != Cut::kNone,
                   "Hide a part of the surface, to look inside  (X)"))
        state.ToggleCut();
    if (state.finishing.offered() &&
        row.Button("finish", "Finish", state.finishing.state() == BackgroundJob::State::kRunning,
                   "Make a clean, textured model: model.glb, model.obj  (G)"))
        state.finishing.Start();
    row.Gap();
    if ((state.link || state.replay) &&
        row.Button("follow", "Follow", view.follow, "Stay with the camera  (F)"))
        state.ToggleFollow();
    if (row.Button("first_person", "First person", view.first_person,
                   "Look around from one place instead of turning the scene  (E)"))
        state.ToggleFirstPerson();
    if (row.Button("view_all", "Whole", view.keep_all,
                   "Keep all of the mesh in view as it grows  (A)"))
        state.ViewAll();
    row.Gap();
    if (state.link && row.Button("switch_view", "Scan view", false,
                                 "A large view with few buttons, for scanning  (Tab)"))
        state.SwitchView();
    if (row.Button("help", "Help", state.show_help, "Keys and mouse  (H)"))
        state.show_help = !state.show_help;
    ImGui::PopFont();
}

}  // namespace tessera
