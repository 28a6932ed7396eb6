// Widgets used by all panels. Call inside an ImGui frame.
#pragma once

#include <imgui.h>

#include <string>

#include "viz/controls.h"
#include "viz/quality.h"
#include "viz/theme.h"

namespace tessera {

// A fixed part of the window; open for the lifetime of the object.
class [[nodiscard]] Panel {
  public:
    Panel(const char* name, const ControlRect& area, ImGuiWindowFlags more = 0);
    ~Panel();
    Panel(const Panel&) = delete;
    Panel& operator=(const Panel&) = delete;
};

// Draws text in another font or colour.
void SmallText(ImU32 colour, const std::string& text);
void HeadingText(const char* text);
// A label and a thin line at the start of a group.
void GroupTitle(const char* text);
// A label at the left edge of the current column, its value at the right edge.
void LabelledValue(const char* label, const std::string& value, ImU32 colour = palette::kText);
// The text, or its end after "..." if it is wider than that in the current font.
std::string FittedText(const std::string& text, float width);
// Tooltip of the previous item, while the mouse is over it.
void Tip(const char* text);

// True if a key of the window (GLFW_KEY_*) is not for the window: it goes to a text field, or a
// menu is open, which Escape closes. Also outside a frame.
bool TakesKey(int key);

// The traffic light of a quality.
ImU32 ColourOf(QualityLevel level);
void DrawLamp(ImDrawList& list, const ImVec2& centre, ImU32 colour);

// Widgets that record their area as `name` in the controls.
bool MarkedButton(Controls& controls, const char* name, const char* label, float width,
                  bool lit = false, float height = 0);
bool MarkedCheckbox(Controls& controls, const char* name, const char* label, bool& value);
bool MarkedSlider(Controls& controls, const char* name, double& value, double least, double most,
                  const char* format, bool logarithmic = false);

}  // namespace tessera
