#include "viz/background_job.h"

namespace tessera {

void BackgroundJob::Start() {
    if (!work_ || state_ == State::kRunning) return;
    cancelled_ = false;
    newest_step_ = "";
    newest_share_ = 0;
    if (!worker_)
        worker_.emplace(
            1,
            [this](const Work& work) {
                result_ = work([this](const char* step, double share) {
                    newest_step_ = step;
                    newest_share_ = share;
                    return !cancelled_.load();
                });
            },
            WorkerOptions{.low_priority = true});
    worker_->PushOrWait(Work(work_));
    state_ = State::kRunning;
    step_ = "";
    share_ = 0;
    text_.clear();
}

void BackgroundJob::Dismiss() {
    if (state_ == State::kRunning) return;
    state_ = State::kNone;
    text_.clear();
}

bool BackgroundJob::Update() {
    if (state_ != State::kRunning) return false;
    if (worker_->idle()) {
        const Result<std::string> result = *std::move(result_);
        result_.reset();
        state_ = result.ok() ? State::kDone : cancelled_ ? State::kCancelled : State::kFailed;
        text_ = result.ok() ? result.value() : result.message();
        return true;
    }
    const char* const step = newest_step_;
    const double share = newest_share_;
    if (step == step_ && share == share_) return false;
    step_ = step;
    share_ = share;
    return true;
}

}  // namespace tessera
