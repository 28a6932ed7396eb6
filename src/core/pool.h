// Recycles objects with expensive storage (images, voxel lists) instead of allocating them for
// every frame.
#pragma once

#include <concurrentqueue/concurrentqueue.h>

#include <memory>

namespace tessera {

// Any thread may take and give; lock-free. Take returns a recycled object in the state in which it
// was given, or a new one.
template <class T>
class Pool {
  public:
    std::unique_ptr<T> Take() {
        std::unique_ptr<T> item;
        return free_.try_dequeue(item) ? std::move(item) : std::make_unique<T>();
    }
    void Give(std::unique_ptr<T> item) {
        if (item) free_.enqueue(std::move(item));
    }

  private:
    moodycamel::ConcurrentQueue<std::unique_ptr<T>> free_;
};

}  // namespace tessera
