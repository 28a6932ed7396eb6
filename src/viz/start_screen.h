// The start screen: a window in which a person chooses what to scan or to show, and how. What was
// chosen is a command line, and whoever called the screen does it.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/image.h"
#include "core/status.h"
#include "io/openni_devices.h"
#include "viz/screen_options.h"
#include "viz/start_choices.h"
#include "viz/viewer.h"

namespace tessera {

// What a path is, in one line.
struct PathFinding {
    bool can_run = false;   // a source of frames
    bool can_view = false;  // a mesh, a run or a scan
    bool failed = false;    // the text says what is wrong with it
    std::string text;
};

// What the screen asks the program for. The first two are called on threads of the screen's own.
struct StartServices {
    std::function<PathFinding(const std::string& path)> examine;
    std::function<OpenniListing()> list_cameras;
    // Whether the run in this folder is moved aside when the next is written there; empty: it is
    // replaced.
    std::function<bool(const std::string& folder)> keeps_run = {};
    std::vector<std::string> models;  // detection networks to choose from
    std::string recent_file;          // RecentFile(); empty: nothing is remembered
};

// Main thread only: opened, run and destroyed there.
class StartScreen {
  public:
    // Fails with a one-line message if there is no display, or if the build has no window.
    static Result<std::unique_ptr<StartScreen>> Open(StartServices services,
                                                     const ScreenOptions& options);
    ~StartScreen();
    StartScreen(const StartScreen&) = delete;
    StartScreen& operator=(const StartScreen&) = delete;

    // Until something is chosen: the words of its command line. Empty: the window was closed.
    std::vector<std::string> Run();
    // One iteration. False when something is chosen or the window should close.
    bool RunOnce();
    // One iteration while what was chosen is being opened: nothing can be changed. False when the
    // window should close.
    bool Wait();
    // Shows why what was chosen cannot be done; another choice can be made.
    void Refuse(const std::string& why);

    // For the viewer to go on in.
    std::shared_ptr<Window> window() const;
    const StartChoices& choices() const;
    // As Viewer's.
    ColourImage Picture();
    std::optional<ControlRect> FindControl(const std::string& name) const;

  private:
    struct Impl;
    explicit StartScreen(std::unique_ptr<Impl> impl);
    std::unique_ptr<Impl> impl_;
};

}  // namespace tessera
