// Handles the user's commands from the viewer window: pause, resume and step here, all others for
// the caller.
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <thread>

#include "core/notices.h"
#include "system/viewer_link.h"

namespace tessera {

// Why a scan is not saved, nor a map cleared.
inline constexpr const char* kMapIsKept =
    "--localise-only: the map and the scan stay as they are, and no other scan is saved";

// Owner thread only: the thread that lets frames in. Without a viewer, every frame passes.
class RunControl {
  public:
    explicit RunControl(ViewerLink* viewer) : viewer_(viewer) {}

    // The next command other than pause, resume and step. Call until it returns nothing.
    std::optional<ViewerCommand> TakeCommand() {
        ViewerCommand command;
        while (viewer_ != nullptr && viewer_->commands.TryPop(command)) {
            using Kind = ViewerCommand::Kind;
            switch (command.kind) {
                case Kind::kPause: SetPaused(true); break;
                case Kind::kResume: SetPaused(false); break;
                case Kind::kStep: ++steps_, SetPaused(true); break;
                case Kind::kReset:
                case Kind::kSaveScan:
                    if (refusals_ == nullptr) return command;
                    refusals_->Tell(kMapIsKept);
                    break;
                default: return command;
            }
        }
        return std::nullopt;
    }

    // Refuses what would change the map, and says so in `notices`, which outlives the object.
    void KeepMap(Notices& notices) { refusals_ = &notices; }

    // For a thread that polls for commands and for a stop signal, which cannot wake it.
    static void SleepBriefly() { std::this_thread::sleep_for(std::chrono::milliseconds(10)); }

    // No frame may pass now.
    bool waiting() const { return paused_ && steps_ == 0; }

    // Call for a frame that is there: whether it may pass. Uses up one step while paused.
    bool TakeTurn() {
        if (waiting()) return false;
        if (paused_) --steps_;
        return true;
    }

  private:
    void SetPaused(bool paused) {
        paused_ = paused;
        if (!paused) steps_ = 0;
        viewer_->paused.store(paused);
        viewer_->system.Notify();
    }

    ViewerLink* viewer_;
    Notices* refusals_ = nullptr;
    bool paused_ = false;
    int steps_ = 0;
};

}  // namespace tessera
