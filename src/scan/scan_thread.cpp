#include "scan/scan_thread.h"

#include "core/check.h"
#include "core/stopwatch.h"

namespace tessera {

ScanThread::ScanThread(std::unique_ptr<ScanWriter> writer, Notices& notices)
    : writer_(std::move(writer)),
      notices_(notices),
      worker_(1, [this](std::unique_ptr<ScanCheckpoint>& job) { WriteNow(std::move(job)); }) {}

ScanThread::~ScanThread() { Stop(); }

void ScanThread::Write(std::unique_ptr<ScanCheckpoint> checkpoint) {
    TESSERA_CHECK(worker_.TryPush(std::move(checkpoint)),
                  "a checkpoint while one is being written");
}

void ScanThread::WriteNow(std::unique_ptr<ScanCheckpoint> checkpoint) {
    if (!failed_.load()) {
        Stopwatch watch;
        if (Status status = writer_->Write(*checkpoint); !status.ok()) {
            failed_.store(true);
            notices_.Tell("the scan is no longer saved: " + status.message() +
                          "; everything saved before is intact");
        }
        total_ms_ += watch.LapMs();
        ++written_;
    }
    checkpoint->Clear();
    pool_.Give(std::move(checkpoint));
}

void ScanThread::Stop() {
    if (!writer_) return;
    worker_.Finish();
    writer_->Close();
    writer_.reset();
}

}  // namespace tessera
