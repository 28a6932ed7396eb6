// Things whose storage is worth keeping (images, lists of voxels) go round instead of being made
// anew for each frame.
#pragma once

#include <concurrentqueue/concurrentqueue.h>

#include <memory>

namespace tessera {

// Any threads take and give; lock-free. What is taken is as it was given, or new.
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
