// Bounded lock-free queues between threads. They differ in what they do when full. Neither blocks:
// an idle consumer sleeps on its Wake (wake.h), and every push notifies it. While a push is under
// way, `empty` may be false although TryPop gives nothing yet.
#pragma once

#include <concurrentqueue/concurrentqueue.h>
#include <readerwriterqueue/readerwriterqueue.h>

#include <atomic>
#include <cstddef>
#include <optional>
#include <utility>

#include "core/wake.h"

namespace tessera {

// Single producer, single consumer. When full, it refuses the push; it never drops an item.
template <class T>
class FifoQueue {
  public:
    // `capacity` is at least 1. `consumer` must outlive the queue. Several queues of the same
    // consumer thread may share it.
    FifoQueue(std::size_t capacity, Wake& consumer)
        : queue_(capacity), capacity_(capacity), consumer_(consumer) {}

    // Returns false if full and leaves `item` unchanged.
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

    // Reliable in the pushing and the popping thread; other threads may see a stale value.
    std::size_t size() const { return size_.load(); }
    bool empty() const { return size() == 0; }
    std::size_t capacity() const { return capacity_; }

  private:
    moodycamel::ReaderWriterQueue<T> queue_;
    const std::size_t capacity_;
    Wake& consumer_;
    std::atomic<std::size_t> size_{0};
};

// Any thread may push and pop. Items from one producer keep their order. When full, a push drops
// the oldest item, so that a slow consumer sees the newest ones.
template <class T>
class NewestQueue {
  public:
    NewestQueue(std::size_t capacity, Wake& consumer)
        : queue_(capacity), capacity_(capacity), consumer_(consumer) {}

    // Returns the item dropped to make room, if any.
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
    // Incremented before an item is enqueued and decremented after it is dequeued, so it is never
    // less than the number of items in the queue.
    std::atomic<std::size_t> size_{0};
};

}  // namespace tessera
