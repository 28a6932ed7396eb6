// Records raw frames on a thread of its own, so that a slow disk never holds the camera up.
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
    // When more frames wait than the queue holds: `wait_when_full`, or the new frame is not
    // recorded, and counted.
    RecorderThread(const SourceInfo& source, const RecordConfig& config, bool wait_when_full);
    ~RecorderThread();  // as Stop

    // A folder, made anew. An error leaves things as they were: also, if something is being
    // recorded already.
    Status Start(const std::string& folder);
    // Takes a copy.
    void Add(const Frame& frame);
    // Waits until all that was added is written.
    void Stop();
    bool recording() const { return thread_.joinable() && !failed_.load(); }

    // What a person should know, in order: where it goes, that it ended and why, how much is safe.
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
    std::unique_ptr<FrameRecorder> recorder_;  // the thread's, while it runs
    std::int64_t dropped_ = 0;
    std::atomic<bool> done_{false};    // no more frames come
    std::atomic<bool> failed_{false};  // nothing more is written
    std::jthread thread_;
};

}  // namespace tessera
