// Lets an idle thread sleep until a condition on queues and flags holds. Whoever changes them wakes
// the thread.
#pragma once

#include <atomic>
#include <cstdint>

namespace tessera {

// Thread-safe, no lock. A waiting thread uses no CPU time.
class Wake {
  public:
    // Call this after the change that the condition depends on.
    void Notify() {
        events_.fetch_add(1);
        events_.notify_all();
    }

    // Returns when the condition holds. Re-evaluates it after each Notify.
    template <class Condition>
    void Wait(Condition condition) {
        while (true) {
            // Read the counter before the condition, so that a change after the check ends the
            // wait.
            const std::uint32_t seen = events_.load();
            if (condition()) return;
            events_.wait(seen);
        }
    }

  private:
    std::atomic<std::uint32_t> events_{0};
};

}  // namespace tessera
