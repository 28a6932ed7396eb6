// State shared by the window's panels: what they show, the user's choices, and the actions of the
// controls. A button and its key call the same function.
#pragma once

#include <string>

#include "viz/controls.h"
#include "viz/system_view.h"
#include "viz/viewer.h"

namespace tessera {

inline constexpr int kShadings = 5;
const char* ToString(Shading shading);

struct ViewChoices {
    Shading shading = Shading::kColour;
    bool keep_all = false;  // keep all of the mesh in view
    bool wireframe = false, depth_test = true, follow = true, show_truth = true;
    bool show_objects = true;  // boxes and names
};

// Owner thread only.
struct ViewerState {
    ViewerState(ViewerLink* to_system, const ViewerOptions& given)
        : link(to_system), options(given), settings(given.settings) {
        view.shading = given.shading;
        view.follow = given.follow;
        view.keep_all = !given.follow;
    }

    ViewerLink* const link;  // null: a model without a running system
    const ViewerOptions options;
    SystemView system;
    Controls controls;
    ViewChoices view;
    ViewerSettings settings;  // as last sent
    int selected_object = 0;  // MapObject::id; 0: none
    bool ask_reset = false, show_help = false, close = false, want_screenshot = false;

    bool ended() const { return !link || link->ended; }
    bool paused() const { return link && link->paused; }
    bool recording() const { return link && link->recording; }
    // Sends all settings; call after changing `settings`.
    void SendSettings();
    void SelectMethod(TrackingMethod method);
    // Rasterised or ray cast, for ICP and for labels.
    void RasteriseViews(bool on);
    void UseClass(int id, bool on);
    void TogglePause();
    void Step();
    void Reset();  // after the user confirmed
    void SaveMesh();
    void SaveScan();
    void ToggleRecording();
    void CycleShading();  // skips shadings without data
    bool CanShade(Shading shading) const;
    void ToggleFollow();
    void ViewAll();
    // Handles a key of the window: GLFW_KEY_* and GLFW_MOD_*.
    void OnKey(int key, int mods);
    // Returns "DIR/PREFIX-YYYYMMDD-HHMMSS.EXTENSION", with a number appended if that exists.
    // Creates the folder.
    std::string NewFileName(const char* prefix, const char* extension) const;

  private:
    void Send(ViewerCommand::Kind kind, const std::string& path = {});
};

}  // namespace tessera
