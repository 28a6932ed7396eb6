#include "system/recorder_thread.h"

#include <fmt/format.h>

namespace tessera {

RecorderThread::RecorderThread(const SourceInfo& source, const RecordConfig& config,
                               bool wait_when_full)
    : source_(source), config_(config), wait_when_full_(wait_when_full) {}

RecorderThread::~RecorderThread() { Stop(); }

Status RecorderThread::Start(const std::string& folder) {
    if (!recording()) Stop();
    if (thread_.joinable())
        return Status::Error(folder + ": not recorded: a recording to " + folder_ +
                             " is in progress");
    Result<std::unique_ptr<FrameRecorder>> recorder =
        FrameRecorder::Create(folder, source_, config_);
    if (!recorder.ok()) return recorder.status();
    recorder_ = std::move(recorder.value());
    folder_ = folder;
    dropped_ = 0;
    done_.store(false);
    failed_.store(false);
    messages_.Push("recording to " + folder);
    thread_ = std::jthread([this] { WriteFrames(); });
    return Status::Ok();
}

void RecorderThread::Add(const Frame& frame) {
    if (!recording()) return;
    std::unique_ptr<Frame> copy = pool_.Take();
    *copy = frame;
    if (wait_when_full_)
        return adder_.Wait([&] { return failed_.load() || frames_.TryPush(std::move(copy)); });
    if (frames_.TryPush(std::move(copy))) return;
    ++dropped_;
    pool_.Give(std::move(copy));
}

void RecorderThread::WriteFrames() {
    while (true) {
        std::unique_ptr<Frame> frame;
        writer_.Wait([&] { return frames_.TryPop(frame) || done_.load(); });
        if (!frame && !frames_.TryPop(frame)) return;
        adder_.Notify();
        if (!failed_.load()) {
            if (Status status = recorder_->Add(*frame); !status.ok()) {
                failed_.store(true);
                adder_.Notify();
                messages_.Push("recording ended: " + status.message());
            }
        }
        pool_.Give(std::move(frame));
    }
}

void RecorderThread::Stop() {
    if (!thread_.joinable()) return;
    done_.store(true);
    writer_.Notify();
    thread_.join();
    const Status status = recorder_->Finish();
    if (!failed_.load())
        messages_.Push(
            !status.ok()
                ? "recording: " + status.message()
                : fmt::format("recorded {} frames in {}{}", recorder_->frames(), folder_,
                              dropped_ > 0
                                  ? fmt::format("; {} dropped, the disk is too slow", dropped_)
                                  : std::string()));
    recorder_.reset();
}

std::optional<std::string> RecorderThread::TakeMessage() {
    std::string message;
    if (!messages_.TryPop(message)) return std::nullopt;
    return message;
}

}  // namespace tessera
