// Brings cubes back from the scan file on a thread of its own, so that nobody waits for the disk
// who does not want to.
#pragma once

#include <atomic>
#include <memory>
#include <thread>

#include "core/pool.h"
#include "core/queue.h"
#include "scan/cube_reader.h"

namespace tessera {

struct StoredCube {
    std::int64_t key = 0;
    BlockCopies blocks;
    Status status;  // an error: `blocks` do not hold
};

// One thread owns it.
class Pager {
  public:
    // That may be asked for and not yet taken.
    static constexpr std::size_t kMostAsked = 16;

    explicit Pager(std::unique_ptr<CubeReader> reader);
    ~Pager();  // after the cube at hand, joins

    // In the order in which they are to come. Fewer than kMostAsked are under way.
    void Ask(std::int64_t cube_key);
    // How many were asked for and not taken.
    std::size_t under_way() const { return under_way_; }
    // The next one; null if it is not there yet.
    std::unique_ptr<StoredCube> TryTake();
    // The next one, waited for. Only while one is under way.
    std::unique_ptr<StoredCube> Take();
    // Its storage is used again.
    void Give(std::unique_ptr<StoredCube> cube) { pool_.Give(std::move(cube)); }

  private:
    void ReadAll();

    std::unique_ptr<CubeReader> reader_;  // the thread's
    Wake wake_, owner_wake_;
    Pool<StoredCube> pool_;
    FifoQueue<std::int64_t> asked_{kMostAsked, wake_};
    FifoQueue<std::unique_ptr<StoredCube>> read_{kMostAsked, owner_wake_};
    std::size_t under_way_ = 0;  // the owner's
    std::atomic<bool> done_{false};
    std::jthread thread_;
};

}  // namespace tessera
