// libfreenect's context and the thread that serves it. The library is not thread-safe, so each of
// its calls is made under one lock.
#pragma once

#include <libfreenect.h>

#include <atomic>
#include <functional>
#include <mutex>
#include <set>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace tessera::kinect {

class UsbThread {
  public:
    UsbThread() = default;
    ~UsbThread();
    UsbThread(const UsbThread&) = delete;
    UsbThread& operator=(const UsbThread&) = delete;

    // `changed` is called on the thread, without the lock, with the serial numbers of the cameras
    // that came and went. Those of the start are reported before Start returns. False: no USB.
    using Changed = std::function<void(const std::vector<std::string>& came,
                                       const std::vector<std::string>& went)>;
    bool Start(Changed changed);
    void Stop();

    // Runs `work` under the lock. Image callbacks come under the lock, too.
    template <class Work>
    auto Locked(const Work& work) {
        ++waiting_;
        const std::lock_guard lock(mutex_);
        --waiting_;
        return work();
    }
    // Runs `work` for the device soon, on the thread and under the lock; for callers that may hold
    // a lock that an image callback takes.
    void Later(freenect_device* device, std::function<void()> work);
    // Under the lock: closes the device, for which nothing is done any more.
    void Close(freenect_device* device);

    freenect_context* context() const { return context_; }

  private:
    using LateWork = std::vector<std::pair<freenect_device*, std::function<void()>>>;
    void Run(const std::stop_token& stop);
    LateWork TakeLater();
    void LookForChanges();

    freenect_context* context_ = nullptr;
    Changed changed_;
    // Of the cameras that are there. Of the thread alone, once it runs.
    std::set<std::string> serials_;
    int count_ = 0;
    std::mutex mutex_;
    std::atomic<int> waiting_ = 0;  // callers of Locked, which the thread lets go first
    std::mutex later_mutex_;
    LateWork later_;
    std::jthread thread_;
};

}  // namespace tessera::kinect
