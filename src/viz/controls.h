// Records by name where each control was drawn, so that tests can click on it. Owner thread only.
#pragma once

#include <map>
#include <optional>
#include <string>

#include "viz/viewer.h"

namespace tessera {

class Controls {
  public:
    void BeginFrame() { rects_.clear(); }
    // Records the item that ImGui drew last.
    void MarkLast(const std::string& name);
    void Mark(const std::string& name, const ControlRect& rect) { rects_[name] = rect; }
    std::optional<ControlRect> Find(const std::string& name) const {
        const auto found = rects_.find(name);
        return found == rects_.end() ? std::nullopt : std::optional(found->second);
    }

  private:
    std::map<std::string, ControlRect> rects_;
};

}  // namespace tessera
