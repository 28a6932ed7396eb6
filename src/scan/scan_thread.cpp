#include "scan/scan_thread.h"

#include "core/check.h"
#include "core/stopwatch.h"

namespace tessera {

ScanThread::ScanThread(std::unique_ptr<ScanWriter> writer)
    : writer_(std::move(writer)), thread_([this] { WriteAll(); }) {}

ScanThread::~ScanThread() { Stop(); }

void ScanThread::WaitUntilIdle() {
    idle_wake_.Wait([&] { return idle(); });
}

void ScanThread::Write(std::unique_ptr<ScanCheckpoint> checkpoint) {
    writing_.store(true);
    TESSERA_CHECK(checkpoints_.TryPush(std::move(checkpoint)),
                  "a checkpoint while one is being written");
}

void ScanThread::WriteAll() {
    while (true) {
        std::unique_ptr<ScanCheckpoint> checkpoint;
        wake_.Wait([&] { return checkpoints_.TryPop(checkpoint) || done_.load(); });
        if (!checkpoint && !checkpoints_.TryPop(checkpoint)) return;
        if (!failed_.load()) {
            Stopwatch watch;
            if (Status status = writer_->Write(*checkpoint); !status.ok()) {
                failed_.store(true);
                messages_.Push("the scan is no longer saved: " + status.message() +
                               "; everything saved before is intact");
            }
            total_ms_ += watch.LapMs();
            ++written_;
        }
        checkpoint->Clear();
        pool_.Give(std::move(checkpoint));
        writing_.store(false);
        idle_wake_.Notify();
    }
}

void ScanThread::Stop() {
    if (!thread_.joinable()) return;
    done_.store(true);
    wake_.Notify();
    thread_.join();
    writer_->Close();
    writer_.reset();
}

std::optional<std::string> ScanThread::TakeMessage() {
    std::string message;
    if (!messages_.TryPop(message)) return std::nullopt;
    return message;
}

}  // namespace tessera
