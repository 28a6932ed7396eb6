// How a thread that has nothing to do sleeps: it waits for a condition over queues and flags that
// other threads fill, and whoever fills one wakes it.
#pragma once

#include <atomic>
#include <cstdint>

namespace tessera {

// Thread-safe. No lock; a waiting thread uses no processor.
class Wake {
  public:
    // To be called after the change that a condition looks at.
    void Notify() {
        events_.fetch_add(1);
        events_.notify_all();
    }

    // Returns when the condition holds; it is looked at again after each Notify.
    template <class Condition>
    void Wait(Condition condition) {
        while (true) {
            // Counted before the look, so that a change after the look ends the wait.
            const std::uint32_t seen = events_.load();
            if (condition()) return;
            events_.wait(seen);
        }
    }

  private:
    std::atomic<std::uint32_t> events_{0};
};

}  // namespace tessera
