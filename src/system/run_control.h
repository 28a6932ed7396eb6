// What a person asks of a running system through its window: which frames may pass, and what else
// is to be done.
#pragma once

#include <optional>
#include <string>

#include "system/viewer_link.h"

namespace tessera {

// Owner thread only: the one that lets frames in. Without a viewer every frame passes.
class RunControl {
  public:
    explicit RunControl(ViewerLink* viewer) : viewer_(viewer) {}

    // The next thing to be done that is not about which frames pass; nothing if there is none. To
    // be called until then.
    std::optional<ViewerCommand> TakeCommand() {
        ViewerCommand command;
        while (viewer_ != nullptr && viewer_->commands.TryPop(command)) {
            using Kind = ViewerCommand::Kind;
            switch (command.kind) {
                case Kind::kPause: SetPaused(true); break;
                case Kind::kResume: SetPaused(false); break;
                case Kind::kStep: ++steps_, SetPaused(true); break;
                default: return command;
            }
        }
        return std::nullopt;
    }

    bool waiting() const { return paused_ && steps_ == 0; }

    // Whether a frame may pass now; a step is used up by it.
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
    }

    ViewerLink* viewer_;
    bool paused_ = false;
    int steps_ = 0;
};

}  // namespace tessera
