// State shared by the window's panels: what they show, the user's choices, and the actions of the
// controls. A button and its key call the same function.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "viz/background_job.h"
#include "viz/controls.h"
#include "viz/measuring.h"
#include "viz/quality.h"
#include "viz/system_view.h"
#include "viz/viewer.h"

namespace tessera {

inline constexpr int kShadings = 6;
const char* ToString(Shading shading);

// What the 3D view hides, to look inside.
enum class Cut {
    kNone,
    kAbove,  // what is higher than a level plane
    kFront,  // what is nearer than an upright plane that faced the viewer when this was chosen
};

struct ViewChoices {
    Shading shading = Shading::kColour;
    bool keep_all = false;  // keep all of the mesh in view
    bool wireframe = false, depth_test = true, follow = true, show_truth = true;
    bool show_objects = true;   // boxes and names
    bool coverage = true;       // kScan: show the coverage instead of colours alone
    bool camera_image = true;   // kScan: what the camera sees, in a corner
    bool first_person = false;  // look from the camera's place instead of from behind it
    Cut cut = Cut::kNone;
    double cut_at = 0.7;  // where, from 0, which hides all, to 1, which hides nothing
    Eigen::Vector3d cut_towards = {0, 0, -1};  // kFront: where the viewer was, level, unit length
};

// Owner thread only.
struct ViewerState {
    ViewerState(ViewerLink* to_system, const ViewerOptions& given)
        : link(to_system), options(given), settings(given.settings) {
        view.shading = given.shading;
        view.follow = given.follow;
        view.keep_all = !given.follow;
        view_kind = to_system ? given.view_kind : ViewKind::kExpert;
    }

    ViewerLink* const link;  // null: a model without a running system
    const ViewerOptions options;
    SystemView system;
    std::optional<Replay> replay;  // of a finished run
    Controls controls;
    Measuring measuring;
    BackgroundJob finishing;  // makes a finished model of what is shown
    ViewKind view_kind = ViewKind::kExpert;
    ViewChoices view;
    double now_s = 0;                     // of this round, on the window's clock
    ViewerSettings settings;              // as last sent
    std::array<char, 1024> typed_path{};  // of a detector
    int selected_object = 0;              // MapObject::id; 0: none
    bool has_final_mesh = false;          // of the run, all of it
    bool ask_reset = false, show_help = false, close = false, want_screenshot = false;

    bool ended() const { return !link || link->ended; }
    bool paused() const { return link && link->paused; }
    bool recording() const { return link && link->recording; }
    // The system, or what it left, can still be saved.
    bool can_save() const { return link && (!link->ended || link->keeps_map); }
    // Objects are labelled, since the start or since a detector was chosen.
    bool labelled() const { return options.labelled || system.classes().count() > 0; }
    // A question is on screen. It gets all keys, and the mouse.
    bool asks() const { return ask_reset; }
    Shading shading() const;
    Quality quality() const;
    // Sends all settings; call after changing `settings`.
    void SendSettings();
    void SelectMethod(TrackingMethod method);
    // The newest frame's, which the run may have switched; a choice of the user that no frame has
    // heeded yet.
    TrackingMethod method() const;
    // Rasterised or ray cast, for ICP and for labels.
    void RasteriseViews(bool on);
    void UseClass(int id, bool on);
    void UseDetector(const std::string& name);
    // The one in use, which a chosen one is not before it is open; empty: none.
    const std::string& detector() const {
        return system.detector().empty() ? options.detector : system.detector();
    }
    void TogglePause();
    void Step();
    void Reset();  // after the user confirmed
    void SaveMesh();
    void SaveScan();
    void ToggleRecording();
    void CycleShading();  // skips shadings without data
    bool CanShade(Shading shading) const;
    void ToggleFollow();
    void ToggleFirstPerson();
    void ViewAll();
    // Call in each round. True if a message came or has stood long enough.
    bool UpdateNote();
    // The newest message, while it stands over the 3D view; else null.
    const std::string* note() const;
    void SwitchView();  // between kScan and kExpert
    // Once the surface no longer changes.
    bool can_measure() const { return !link || has_final_mesh; }
    void ToggleMeasuring();
    void ReadMeasurementsOnce();
    void ToggleCut();
    // Handles a key of the window: GLFW_KEY_* and GLFW_MOD_*.
    void OnKey(int key, int mods);
    // Returns "DIR/PREFIX-YYYYMMDD-HHMMSS.EXTENSION", with a number appended if that exists.
    // Creates the folder.
    std::string NewFileName(const char* prefix, const char* extension) const;

  private:
    void Send(ViewerCommand::Kind kind, const std::string& path = {});
    bool OnReplayKey(int key, int mods);  // true: it was one of the time line's
    bool OnMeasuringKey(int key);         // true: it was one of the measuring tool's
    void Answer(int key);

    bool measurements_read_ = false;
    std::uint64_t noted_ = 0;  // messages so far
    double note_until_s_ = 0;  // on the window's clock
    bool note_stands_ = false;
};

}  // namespace tessera
