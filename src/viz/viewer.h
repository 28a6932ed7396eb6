// The window: shows what a running system sends over a ViewerLink, and sends the user's input back
// over it.
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
#include "viz/background_job.h"
#include "viz/frame_images.h"
#include "viz/screen_options.h"
#include "viz/time_line.h"

namespace tessera {

class Window;

// Shading of the mesh.
enum class Shading {
    kColour,  // colours of the scene
    kLabel,   // classes of the objects
    kWeight,  // how often a surface was measured
    kGrey,
    kNormal,
    kCoverage,  // the scene's colours where it is well measured, else orange or red (coverage.h)
};

// What the window consists of.
enum class ViewKind {
    kScan,    // a large 3D view, one line about quality, a few large buttons
    kExpert,  // also instruments, images and all settings
};

struct ViewerOptions {
    std::string title;  // name of what is scanned or shown
    ScreenOptions screen;
    // For screenshots, saved meshes and recordings; created when first needed.
    std::string output_folder = ".";
    std::string measurements;    // file that keeps them; empty: they are not kept
    PinholeCamera camera;        // of the frames
    double truncation_m = 0.04;  // of the map; limit of the residual's colour scale
    bool labelled = false;       // true if there is a detector, or if the model's mesh has labels
    double max_weight = 128;     // of the map's voxels; sets the levels of the coverage
    std::string detector;        // in use when the window opens, as for --labels; may be empty
    std::vector<std::string> models;         // to choose from
    ViewerSettings settings;                 // active when the window opens
    ViewKind view_kind = ViewKind::kExpert;  // initial; without a running system always kExpert
    Shading shading = Shading::kColour;      // initial
    // Initially follow the sensor; otherwise show all of the mesh until the user moves the view.
    bool follow = true;
    // When ViewerLink::ended is set; otherwise the user closes the window.
    bool close_at_end = false;
    // A message stands over the 3D view for so long, where there is no list of them.
    double message_s = 8;
    double max_fps = 0;  // drawing rate; 0: 60 on a GPU, 15 in software
    // Go on in this window (StartScreen::window) instead of opening one.
    std::shared_ptr<Window> window;
};

// A mesh to display without a running system: `tessera view`.
struct ViewedModel {
    TriangleMesh mesh;
    std::vector<Eigen::Isometry3d> path;  // T_world_camera of the run; may be empty
    std::vector<MapObject> objects;       // matching the mesh's labels; may be empty
    std::optional<TimeLine> time_line;    // of the run; shown below the mesh
    FrameImages::Open open_source;        // with a time line: what the run read; may be empty
    BackgroundJob::Work finish;           // makes a finished model of it; may be empty
};

// Area of a control in the window, in pixels from the top left corner.
struct ControlRect {
    float x = 0, y = 0, width = 0, height = 0;
};

// Main thread only: opened, run and destroyed there. Only one per process at a time.
class Viewer {
  public:
    // The link must outlive the viewer. Fails with a one-line message if there is no display or no
    // OpenGL 3.3, or if the build has no window. The caller may then continue without it.
    static Result<std::unique_ptr<Viewer>> Open(ViewerLink& link, const ViewerOptions& options);
    static Result<std::unique_ptr<Viewer>> OpenModel(ViewedModel model,
                                                     const ViewerOptions& options);
    ~Viewer();
    Viewer(const Viewer&) = delete;
    Viewer& operator=(const Viewer&) = delete;

    // Runs until the window is closed, the display is lost, or the run has ended with
    // options.close_at_end. On return kStop was sent to the system, unless it had already ended.
    void Run();
    // One iteration: takes updates, handles input, draws if anything changed. Returns false when
    // the window should close.
    bool RunOnce();

    // Returns what the window currently shows, with an anti-aliased 3D view. Empty if the window is
    // closing or minimised, or the display is lost.
    ColourImage Picture();

    // Returns where a control or panel was last drawn, by name (docs/window.md lists the names).
    // Empty while it is hidden.
    std::optional<ControlRect> FindControl(const std::string& name) const;

  private:
    struct Impl;
    explicit Viewer(std::unique_ptr<Impl> impl);
    std::unique_ptr<Impl> impl_;
};

}  // namespace tessera
