// Writes a scan on its own thread, so that neither compression nor the disk delays anyone.
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

// One thread owns it. Checkpoints are recycled: in steady state nothing large is allocated.
class ScanThread {
  public:
    explicit ScanThread(std::unique_ptr<ScanWriter> writer);
    ~ScanThread();  // like Stop

    // True if there is room for a checkpoint. If not, make it later, with more content.
    bool idle() const { return checkpoints_.empty() && !writing_.load(); }
    void WaitUntilIdle();
    std::unique_ptr<ScanCheckpoint> Take() { return pool_.Take(); }
    // Call it only while idle.
    void Write(std::unique_ptr<ScanCheckpoint> checkpoint);
    // Waits until everything is written, then closes the file.
    void Stop();
    // True if writing has stopped after an error. `TakeMessage` returns the reason. The file is
    // intact up to the last checkpoint before the error.
    bool failed() const { return failed_.load(); }

    std::optional<std::string> TakeMessage();
    // Mean time to write a checkpoint in milliseconds, and the number of checkpoints. Valid after
    // Stop.
    double mean_ms() const { return written_ > 0 ? total_ms_ / written_ : 0; }
    int written() const { return written_; }
    std::size_t waiting() const { return checkpoints_.size(); }

  private:
    void WriteAll();

    std::unique_ptr<ScanWriter> writer_;  // the writer thread's, while it runs
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
