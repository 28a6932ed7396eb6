// Reads cubes back from the scan file on its own thread, so that nobody has to wait for the disk.
#pragma once

#include <memory>

#include "core/pool.h"
#include "core/worker.h"
#include "scan/cube_reader.h"

namespace tessera {

struct StoredCube {
    std::int64_t key = 0;
    BlockCopies blocks;
    Status status;  // if an error, `blocks` is invalid
};

// Owner thread only. Destroying it waits for the current cube.
class Pager {
  public:
    // Largest number of cubes that may be requested and not yet taken.
    static constexpr std::size_t kMostAsked = 16;

    explicit Pager(std::unique_ptr<CubeReader> reader);

    // Requests a cube; cubes are delivered in the order requested. Fewer than kMostAsked must be
    // under way.
    void Ask(std::int64_t cube_key);
    // Number of cubes requested and not yet taken.
    std::size_t under_way() const { return under_way_; }
    // Returns the next cube; null if it has not been read yet.
    std::unique_ptr<StoredCube> TryTake();
    // Waits for the next cube. At least one must be under way.
    std::unique_ptr<StoredCube> Take();
    // Returns a cube so that its storage can be reused.
    void Give(std::unique_ptr<StoredCube> cube) { pool_.Give(std::move(cube)); }

  private:
    void Read(std::int64_t cube_key);

    std::unique_ptr<CubeReader> reader_;  // the worker's
    Pool<StoredCube> pool_;
    Wake owner_;
    FifoQueue<std::unique_ptr<StoredCube>> read_{kMostAsked, owner_};
    std::size_t under_way_ = 0;
    Worker<std::int64_t> worker_;
};

}  // namespace tessera
