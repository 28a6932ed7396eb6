// The window: what a running system sends over a ViewerLink is shown, what the person does goes
// back the same way.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/camera.h"
#include "core/image.h"
#include "core/mesh.h"
#include "core/status.h"
#include "system/viewer_link.h"

namespace tessera {

// Of the mesh.
enum class Shading {
    kColour,  // the scene's
    kLabel,   // by the objects' classes
    kWeight,  // how often it was measured
    kGrey,
    kNormal,
};

struct ViewerOptions {
    std::string title;  // of what is scanned or shown
    // Of the window at first, in pixels of a display of usual density.
    int width = 1280, height = 720;
    // For screenshots, saved meshes and recordings; made when first needed.
    std::string output_folder = ".";
    PinholeCamera camera;        // of the frames
    double truncation_m = 0.04;  // the map's: the residual's colours reach so far
    bool labelled = false;       // whether there is a detector, or a model's mesh has labels
    ViewerSettings settings;     // in force when the window opens
    Shading shading = Shading::kColour;  // at first
    // The sensor at first; else all of the mesh, until the person turns the view.
    bool follow = true;
    bool close_at_end = false;    // with ViewerLink::ended; else the person closes
    double wait_s = 1.0 / 30;     // how long RunOnce may sleep when there is nothing to do
    double double_click_s = 0.3;  // at most so long between the two clicks
    double max_fps = 0;           // of drawing; 0: 60 on a graphics card, 15 in software
};

// A mesh to look at, without a system: `tessera view`.
struct ViewedModel {
    TriangleMesh mesh;
    std::vector<Eigen::Isometry3d> path;  // T_world_camera of a run; may be empty
    std::vector<MapObject> objects;       // of its labels; may be empty
};

// Of a control in the window, in pixels from its top left corner.
struct ControlRect {
    float x = 0, y = 0, width = 0, height = 0;
};

// Main thread only: opened, run and destroyed there. One at a time in a process.
class Viewer {
  public:
    // The link must outlive the viewer. Fails with one line where there is no display or no
    // OpenGL 3.3, and where the build has no window; the caller may then go on without.
    static Result<std::unique_ptr<Viewer>> Open(ViewerLink& link, const ViewerOptions& options);
    static Result<std::unique_ptr<Viewer>> OpenModel(ViewedModel model,
                                                     const ViewerOptions& options);
    ~Viewer();
    Viewer(const Viewer&) = delete;
    Viewer& operator=(const Viewer&) = delete;

    // Until the window is closed, its display is lost, or the run has ended and
    // options.close_at_end. On return the system was sent kStop, unless it had ended.
    void Run();
    // One round: takes what came, handles input, draws if anything changed. False once the window
    // should close.
    bool RunOnce();

    // What the window shows now, 3D view with smooth edges. Empty if the display is lost.
    ColourImage Picture();

    // Where a control or panel was last drawn, by its name (docs/window.md lists them); none while
    // it is hidden.
    std::optional<ControlRect> FindControl(const std::string& name) const;

  private:
    struct Impl;
    explicit Viewer(std::unique_ptr<Impl> impl);
    std::unique_ptr<Impl> impl_;
};

}  // namespace tessera
