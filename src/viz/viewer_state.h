// What the window's panels share: what they show, what the person has chosen, and what a control does. A button and its
// key call the same function here.
#pragma once

#include <string>

#include "viz/controls.h"
#include "viz/system_view.h"
#include "viz/viewer.h"

namespace tessera {

// More to come with the data for it: labels, weights.
enum class Shading { kColour, kGrey, kNormal };
inline constexpr int kShadings = 3;
const char* ToString(Shading shading);

struct ViewChoices {
    Shading shading = Shading::kColour;
    bool keep_all = false;  // stay so far away that all of the mesh shows
    bool wireframe = false, depth_test = true, follow = true, show_truth = true;
};

// Owner thread only.
struct ViewerState {
    ViewerState(ViewerLink* to_system, const ViewerOptions& given)
        : link(to_system), options(given), settings(given.settings) {
        view.follow = given.follow;
        view.keep_all = !given.follow;
    }

    ViewerLink* const link;  // null: a model without a system
    const ViewerOptions options;
    SystemView system;
    Controls controls;
    ViewChoices view;
    ViewerSettings settings;  // as last sent
    bool ask_reset = false, show_help = false, close = false, want_screenshot = false;

    bool ended() const { return !link || link->ended; }
    bool paused() const { return link && link->paused; }
    bool recording() const { return link && link->recording; }
    // Settings are sent whole; to be called after a change of `settings`.
    void SendSettings();
    void SelectMethod(TrackingMethod method);
    void TogglePause();
    void Step();
    void Reset();  // asked for and confirmed
    void SaveMesh();
    void ToggleRecording();
    void CycleShading();
    void ToggleFollow();
    void ViewAll();
    // The window's keys: GLFW_KEY_* and GLFW_MOD_*.
    void OnKey(int key, int mods);
    // "DIR/PREFIX-YYYYMMDD-HHMMSS.EXTENSION", with a number where that exists already; makes the folder.
    std::string NewFileName(const char* prefix, const char* extension) const;

  private:
    void Send(ViewerCommand::Kind kind, const std::string& path = {});
};

}  // namespace tessera
