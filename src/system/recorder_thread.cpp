#include "system/recorder_thread.h"

#include <fmt/format.h>

namespace tessera {

RecorderThread::RecorderThread(const SourceInfo& source, const RecordConfig& config,
                               bool wait_when_full, Notices& notices)
    : source_(source), config_(config), wait_when_full_(wait_when_full), notices_(notices) {}

RecorderThread::~RecorderThread() { Stop(); }

Status RecorderThread::Start(const std::string& folder) {
    if (!recording()) Stop();
    if (worker_)
        return Status::Error(folder + ": not recorded: a recording to " + folder_ +
                             " is in progress");
    Result<std::unique_ptr<FrameRecorder>> recorder =
        FrameRecorder::Create(folder, source_, config_);
    if (!recorder.ok()) return recorder.status();
    recorder_ = std::move(recorder.value());
    folder_ = folder;
    dropped_ = left_out_ = 0;
    failed_.store(false);
    notices_.Tell("recording to " + folder);
    worker_.emplace(kCapacity, [this](std::unique_ptr<Frame>& frame) { Write(std::move(frame)); });
    return Status::Ok();
}

Status RecorderThread::Start(const std::string& path, FrameSource& source) {
    if (!path.ends_with(".oni")) return Start(path);
    return source.RecordTo(path, config_.colour == RecordConfig::Colour::kPng);
}

void RecorderThread::Add(const Frame& frame) {
    if (!recording()) return;
    std::unique_ptr<Frame> copy = pool_.Take();
    *copy = frame;
    if (wait_when_full_) return worker_->PushOrWait(std::move(copy));
    if (worker_->TryPush(std::move(copy))) return;
    ++dropped_;
    pool_.Give(std::move(copy));
}

void RecorderThread::Write(std::unique_ptr<Frame> frame) {
    if (!failed_.load()) {
        if (const std::string why = recorder_->WhyNot(*frame); !why.empty()) {
            if (left_out_++ == 0) notices_.Tell("recording goes on: " + why);
        } else if (Status status = recorder_->Add(*frame); !status.ok()) {
            failed_.store(true);
            notices_.Tell("recording ended: " + status.message());
        }
    }
    pool_.Give(std::move(frame));
}

void RecorderThread::Stop() {
    if (!worker_) return;
    worker_->Finish();
    worker_.reset();
    const Status status = recorder_->Finish();
    if (!failed_.load())
        notices_.Tell(
            !status.ok()
                ? "recording: " + status.message()
                : fmt::format(
                      "recorded {} frames in {}{}{}", recorder_->frames(), folder_,
                      dropped_ > 0 ? fmt::format("; {} dropped, the disk is too slow", dropped_)
                                   : std::string(),
                      left_out_ > 0 ? fmt::format("; {} left out", left_out_) : std::string()));
    recorder_.reset();
}

}  // namespace tessera
