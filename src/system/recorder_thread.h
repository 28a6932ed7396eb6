// Records raw frames on a separate thread, so that a slow disk never blocks the camera.
#pragma once

#include <atomic>
#include <memory>
#include <optional>
#include <string>
#include <thread>

#include "core/pool.h"
#include "core/queue.h"
#include "io/frame_recorder.h"

namespace tessera {

// Owner thread only.
class RecorderThread {
  public:
    // If the queue is full: waits if `wait_when_full`; else drops the new frame and counts it.
    RecorderThread(const SourceInfo& source, const RecordConfig& config, bool wait_when_full);
    ~RecorderThread();  // calls Stop

    // Creates the folder. An error changes nothing; recording already is an error.
    Status Start(const std::string& folder);
    // Copies the frame.
    void Add(const Frame& frame);
    // Waits until all added frames are written.
    void Stop();
    bool recording() const { return thread_.joinable() && !failed_.load(); }

    // Messages for the user, in order: where the recording goes, why it ended, how many frames were
    // saved.
    std::optional<std::string> TakeMessage();

    std::size_t waiting() const { return frames_.size(); }

  private:
    void WriteFrames();

    static constexpr std::size_t kCapacity = 32;

    const SourceInfo source_;
    const RecordConfig config_;
    const bool wait_when_full_;
    Wake writer_, adder_;
    Pool<Frame> pool_;
    FifoQueue<std::unique_ptr<Frame>> frames_{kCapacity, writer_};
    Wake nobody_;
    NewestQueue<std::string> messages_{16, nobody_};
    std::string folder_;
    std::unique_ptr<FrameRecorder> recorder_;  // owned by the thread while it runs
    std::int64_t dropped_ = 0;
    std::atomic<bool> done_{false};    // no more frames will be added
    std::atomic<bool> failed_{false};  // writing has failed; nothing more is written
    std::jthread thread_;
};

}  // namespace tessera
