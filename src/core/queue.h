// The bounded lock-free queues between threads, by what they do when they are full. Neither waits:
// a consumer with nothing to do sleeps on its Wake (wake.h), which every push notifies.
#pragma once

#include <concurrentqueue/concurrentqueue.h>
#include <readerwriterqueue/readerwriterqueue.h>

#include <atomic>
#include <cstddef>
#include <optional>
#include <utility>

#include "core/wake.h"

namespace tessera {

// One thread pushes, one pops. Full: the push is refused, nothing is ever lost.
template <class T>
class FifoQueue {
  public:
    // At least one item; `consumer` outlives the queue and may be shared with others of the same
    // thread.
    FifoQueue(std::size_t capacity, Wake& consumer)
        : queue_(capacity), capacity_(capacity), consumer_(consumer) {}

    // False if full: `item` is then as it was.
    bool TryPush(T&& item) {
        if (size_.load() >= capacity_) return false;
        size_.fetch_add(1);
        queue_.enqueue(std::move(item));
        consumer_.Notify();
        return true;
    }

    bool TryPop(T& item) {
        if (!queue_.try_dequeue(item)) return false;
        size_.fetch_sub(1);
        return true;
    }

    // Exact for the pushing and the popping thread's own decisions, a moment old for all others.
    std::size_t size() const { return size_.load(); }
    bool empty() const { return size() == 0; }
    std::size_t capacity() const { return capacity_; }

  private:
    moodycamel::ReaderWriterQueue<T> queue_;
    const std::size_t capacity_;
    Wake& consumer_;
    std::atomic<std::size_t> size_{0};
};

// Any threads push and pop; items of one producer keep their order. Full: the oldest makes room, so
// that a slow consumer sees the newest.
template <class T>
class NewestQueue {
  public:
    NewestQueue(std::size_t capacity, Wake& consumer)
        : queue_(capacity), capacity_(capacity), consumer_(consumer) {}

    // The item that was dropped for it, if any.
    std::optional<T> Push(T&& item) {
        std::optional<T> dropped;
        if (size_.fetch_add(1) >= capacity_) {
            T oldest;
            if (TryPop(oldest)) dropped = std::move(oldest);
        }
        queue_.enqueue(std::move(item));
        consumer_.Notify();
        return dropped;
    }

    bool TryPop(T& item) {
        if (!queue_.try_dequeue(item)) return false;
        size_.fetch_sub(1);
        return true;
    }

    std::size_t size() const { return size_.load(); }
    bool empty() const { return size() == 0; }
    std::size_t capacity() const { return capacity_; }

  private:
    moodycamel::ConcurrentQueue<T> queue_;
    const std::size_t capacity_;
    Wake& consumer_;
    // Counted before an item is in and after it is out: never less than there are.
    std::atomic<std::size_t> size_{0};
};

}  // namespace tessera
