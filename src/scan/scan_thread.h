// Writes a scan on its own thread, so that neither compression nor the disk delays anyone.
#pragma once

#include <atomic>
#include <memory>

#include "core/notices.h"
#include "core/pool.h"
#include "core/worker.h"
#include "scan/scan_writer.h"

namespace tessera {

// One thread owns it. Checkpoints are recycled: in steady state nothing large is allocated.
class ScanThread {
  public:
    // `notices`: told if writing fails. It outlives the object.
    ScanThread(std::unique_ptr<ScanWriter> writer, Notices& notices);
    ~ScanThread();  // like Stop

    // True if there is room for a checkpoint. If not, make it later, with more content.
    bool idle() const { return worker_.idle(); }
    void WaitUntilIdle() { worker_.WaitUntilIdle(); }
    std::unique_ptr<ScanCheckpoint> Take() { return pool_.Take(); }
    // Call it only while idle.
    void Write(std::unique_ptr<ScanCheckpoint> checkpoint);
    // Waits until everything is written, then closes the file.
    void Stop();
    // True if writing has stopped after an error. The file is intact up to the last checkpoint
    // before the error.
    bool failed() const { return failed_.load(); }

    // Mean time to write a checkpoint in milliseconds, and the number of checkpoints. Valid after
    // Stop.
    double mean_ms() const { return written_ > 0 ? total_ms_ / written_ : 0; }
    int written() const { return written_; }
    std::size_t waiting() const { return worker_.waiting(); }

  private:
    void WriteNow(std::unique_ptr<ScanCheckpoint> checkpoint);

    std::unique_ptr<ScanWriter> writer_;  // the worker's; null after Stop
    Notices& notices_;
    Pool<ScanCheckpoint> pool_;
    double total_ms_ = 0;
    int written_ = 0;
    std::atomic<bool> failed_{false};
    Worker<std::unique_ptr<ScanCheckpoint>> worker_;
};

}  // namespace tessera
