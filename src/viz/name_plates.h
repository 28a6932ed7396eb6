// Texts on small plates over the 3D view or an image. Call inside an ImGui frame.
#pragma once

#include <imgui.h>

#include <string>
#include <vector>

#include "core/image.h"

namespace tessera {

// Plates do not overlap: a later one moves up until it is free.
class NamePlates {
  public:
    // `opacity` in [0, 1].
    NamePlates(ImDrawList& list, float opacity) : list_(list), opacity_(opacity) {}

    // `at` is the lower left corner; `colour` is shown at the left; `lit`: with a white frame.
    void Draw(const ImVec2& at, const Rgb8& colour, const std::string& text, bool lit);

  private:
    ImVec4 FreePlace(ImVec4 plate);

    ImDrawList& list_;
    float opacity_;
    std::vector<ImVec4> drawn_;
};

}  // namespace tessera
