// Writes a scan on a thread of its own, so that neither compression nor the disk holds anyone up.
#pragma once

#include <atomic>
#include <memory>
#include <optional>
#include <string>
#include <thread>

#include "core/pool.h"
#include "core/queue.h"
#include "scan/scan_writer.h"

namespace tessera {

// One thread owns it. Checkpoints go round: in steady state nothing large is allocated.
class ScanThread {
  public:
    explicit ScanThread(std::unique_ptr<ScanWriter> writer);
    ~ScanThread();  // as Stop

    // Room for one more; if not, the checkpoint is to be made later, of more.
    bool idle() const { return checkpoints_.empty() && !writing_.load(); }
    void WaitUntilIdle();
    std::unique_ptr<ScanCheckpoint> Take() { return pool_.Take(); }
    // Only while idle.
    void Write(std::unique_ptr<ScanCheckpoint> checkpoint);
    // Waits until all is written, and makes the file one again.
    void Stop();
    // Nothing more is written: `TakeMessage` said why. The file is sound up to the last checkpoint
    // before.
    bool failed() const { return failed_.load(); }

    std::optional<std::string> TakeMessage();
    // Mean milliseconds of a checkpoint's writing, and how many there were; after Stop.
    double mean_ms() const { return written_ > 0 ? total_ms_ / written_ : 0; }
    int written() const { return written_; }
    std::size_t waiting() const { return checkpoints_.size(); }

  private:
    void WriteAll();

    std::unique_ptr<ScanWriter> writer_;  // the thread's, while it runs
    Wake wake_, idle_wake_, nobody_;
    Pool<ScanCheckpoint> pool_;
    FifoQueue<std::unique_ptr<ScanCheckpoint>> checkpoints_{1, wake_};
    NewestQueue<std::string> messages_{16, nobody_};
    double total_ms_ = 0;
    int written_ = 0;
    std::atomic<bool> writing_{false}, done_{false}, failed_{false};
    std::jthread thread_;
};

}  // namespace tessera
