// Records raw frames on a separate thread, so that a slow disk never blocks the camera.
#pragma once

#include <atomic>
#include <memory>
#include <string>

#include "core/notices.h"
#include "core/pool.h"
#include "core/worker.h"
#include "io/frame_recorder.h"

namespace tessera {

// Owner thread only.
class RecorderThread {
  public:
    // If the queue is full: waits if `wait_when_full`; else drops the new frame and counts it.
    // `notices` is told where the recording goes, why a frame was left out (of the first one), why
    // it ended and how many frames were saved. It outlives the object.
    RecorderThread(const SourceInfo& source, const RecordConfig& config, bool wait_when_full,
                   Notices& notices);
    ~RecorderThread();  // calls Stop

    // Creates the folder. An error changes nothing; recording already is an error.
    Status Start(const std::string& folder);
    // Call before the source's first frame: the same, or lets the source itself record to FILE.oni.
    Status Start(const std::string& path, FrameSource& source);
    // Copies the frame.
    void Add(const Frame& frame);
    // Waits until all added frames are written.
    void Stop();
    bool recording() const { return worker_ && !failed_.load(); }

    std::size_t waiting() const { return worker_ ? worker_->waiting() : 0; }

  private:
    void Write(std::unique_ptr<Frame> frame);

    static constexpr std::size_t kCapacity = 32;

    const SourceInfo source_;
    const RecordConfig config_;
    const bool wait_when_full_;
    Notices& notices_;
    Pool<Frame> pool_;
    std::string folder_;
    std::unique_ptr<FrameRecorder> recorder_;  // the worker's, while there is one
    std::int64_t dropped_ = 0;
    std::int64_t left_out_ = 0;        // could not be recorded; the worker's, as recorder_
    std::atomic<bool> failed_{false};  // writing has failed; nothing more is written
    std::optional<Worker<std::unique_ptr<Frame>>> worker_;
};

}  // namespace tessera
