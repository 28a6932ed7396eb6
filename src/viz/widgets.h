// The few building blocks that all panels are made of. Inside an ImGui frame.
#pragma once

#include <imgui.h>

#include <string>

#include "viz/controls.h"
#include "viz/theme.h"

namespace tessera {

// A fixed part of the window for as long as it lives.
class [[nodiscard]] Panel {
  public:
    Panel(const char* name, const ControlRect& area, ImGuiWindowFlags more = 0);
    ~Panel();
    Panel(const Panel&) = delete;
    Panel& operator=(const Panel&) = delete;
};

// Text in another font or colour.
void SmallText(ImU32 colour, const std::string& text);
void HeadingText(const char* text);
// A label and a thin line that open a group.
void GroupTitle(const char* text);
// A label at the left edge, its value at the right one of the present column.
void LabelledValue(const char* label, const std::string& value, ImU32 colour = palette::kText);
// For the item before, if the pointer rests on it.
void Tip(const char* text);

// Marked by `name` in the controls.
bool MarkedButton(Controls& controls, const char* name, const char* label, float width,
                  bool lit = false);
bool MarkedCheckbox(Controls& controls, const char* name, const char* label, bool& value);
bool MarkedSlider(Controls& controls, const char* name, double& value, double least, double most,
                  const char* format, bool logarithmic = false);

}  // namespace tessera
