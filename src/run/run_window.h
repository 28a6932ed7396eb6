// Sends a run's outcomes to the viewer window. The map's owner sends meshes and images
// (viewer_feed.h).
#pragma once

#include <string>
#include <vector>

#include "system/engine.h"
#include "system/viewer_link.h"

namespace tessera {

// Owner thread only: the thread that takes an engine's outcomes. Without a window (null), does
// nothing.
class RunWindow {
  public:
    explicit RunWindow(ViewerLink* viewer) : viewer_(viewer) {}

    // `counts`: up to and including this frame. `T_world_camera_truth`: in the map's world, if
    // known.
    void Show(const FrameOutcome& outcome, const RunCounts& counts,
              const std::optional<Eigen::Isometry3d>& T_world_camera_truth);
    void Show(const LabelReport& report, const LabelClasses& classes);
    // Call at the start of a run with labels.
    void Show(const LabelClasses& classes);
    void ShowDetector(const std::string& name);  // one that was chosen is in use
    void EndLabels();
    // Call at the end, after the map's owner has stopped.
    void ShowObjects(const std::vector<MapObject>& objects);
    void Say(const std::string& text);

  private:
    ViewerLink* viewer_;
};

}  // namespace tessera
