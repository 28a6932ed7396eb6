// One long piece of work at a time, for a window that goes on meanwhile: done on a thread of its
// own, with progress, and cancelled when the window closes. All but the work: owner thread only.
#pragma once

#include <atomic>
#include <functional>
#include <optional>
#include <string>

#include "core/status.h"
#include "core/worker.h"

namespace tessera {

class BackgroundJob {
  public:
    // Told by the work what it does next (a literal), and what is done, as a share of all; false:
    // the work is to end soon, with any error.
    using Progress = std::function<bool(const char* step, double share)>;
    // Returns one line about what it made.
    using Work = std::function<Result<std::string>(const Progress& progress)>;
    enum class State { kNone, kRunning, kDone, kFailed, kCancelled };

    BackgroundJob() = default;
    ~BackgroundJob() { Cancel(); }

    void Offer(Work work) { work_ = std::move(work); }
    bool offered() const { return work_ != nullptr; }
    // Does nothing while it runs.
    void Start();
    void Cancel() { cancelled_ = true; }
    // Forgets how it ended.
    void Dismiss();
    // Takes over what is new. True if anything is.
    bool Update();

    State state() const { return state_; }
    const char* step() const { return step_; }         // "" before the first
    double share() const { return share_; }            // in [0, 1]
    const std::string& text() const { return text_; }  // what it made, or what went wrong

  private:
    Work work_;
    State state_ = State::kNone;
    const char* step_ = "";
    double share_ = 0;
    std::string text_;

    std::atomic<bool> cancelled_ = false;
    std::atomic<const char*> newest_step_ = "";
    std::atomic<double> newest_share_ = 0;
    std::optional<Result<std::string>> result_;  // of the thread, until it is idle
    std::optional<Worker<Work>> worker_;         // last: ends before what it uses
};

}  // namespace tessera
