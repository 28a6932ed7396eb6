// What the start screen's panels share: the choices, what is known about them, and the actions of
// the controls. Threads of its own find out what a path is and which cameras there are.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "core/worker.h"
#include "viz/controls.h"
#include "viz/folder_list.h"
#include "viz/start_screen.h"

namespace tessera {

// Owner thread only.
class StartState {
  public:
    // The run that the output folder holds: none; one that the next run replaces; a camera's, which
    // the next run moves to earlier_1 and so on inside it.
    enum class EarlierRun { kNone, kReplaced, kKept };

    explicit StartState(StartServices given);

    // Takes what the threads have found. True if there was anything.
    bool Update();

    // The page of files: what is chosen or typed, and the folder that is listed.
    void Choose(const std::string& path);
    void EnterFolder(const std::string& folder);
    const std::string& folder() const { return folder_; }
    const FolderList& list() const { return list_; }
    const std::vector<std::string>& recent() const { return recent_; }  // that still exist

    void RefreshCameras();
    const std::optional<OpenniListing>& cameras() const { return cameras_; }  // empty: being listed

    void ShowPage(StartPage page);
    // Call after any other change of the choices.
    void Changed();
    // What is chosen, in one line.
    PathFinding finding() const;
    bool can_start() const { return !opening && decision.empty() && finding().can_run; }
    bool can_open() const { return !opening && decision.empty() && finding().can_view; }
    EarlierRun earlier_run() const { return earlier_run_; }
    void Start();
    void Open();
    // The command line of the more likely of the two, as words; empty: neither is possible.
    std::vector<std::string> Words() const;
    // Of the window: GLFW_KEY_*.
    void OnKey(int key);

    const StartServices services;
    Controls controls;
    StartChoices choices;
    std::array<char, 4096> typed_path{}, typed_output{};
    std::string error;     // why the last choice was refused; empty: it was not
    bool opening = false;  // what was chosen is being opened
    bool close = false;
    std::vector<std::string> decision;

  private:
    struct Examined {
        std::string path;
        PathFinding finding;
    };

    std::string folder_ = ".";
    FolderList list_;
    std::vector<std::string> recent_;
    EarlierRun earlier_run_ = EarlierRun::kNone;
    Examined examined_;
    std::string asked_;  // the path that is examined, or was last
    std::optional<OpenniListing> cameras_;
    bool cameras_asked_ = false;
    Wake taken_;
    NewestQueue<Examined> findings_{1, taken_};
    NewestQueue<OpenniListing> listings_{1, taken_};
    Worker<std::string, NewestQueue> examiner_;
    Worker<char, NewestQueue> lister_;
};

// The panels (panel_start*.cpp). Call inside an ImGui frame.
void DrawStart(StartState& state);
// Inside their boxes.
void DrawStartPage(StartState& state);
void DrawStartSettings(StartState& state);

}  // namespace tessera
