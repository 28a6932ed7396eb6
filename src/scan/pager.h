// Brings sectors back from the scan file on a thread of its own, so that nobody waits for the disk who does not want to.
#pragma once

#include <atomic>
#include <memory>
#include <thread>

#include "core/pool.h"
#include "core/queue.h"
#include "scan/sector_reader.h"

namespace tessera {

struct StoredSector {
    std::int64_t key = 0;
    BlockCopies blocks;
    Status status;  // an error: `blocks` do not hold
};

// One thread owns it.
class Pager {
  public:
    // That may be asked for and not yet taken.
    static constexpr std::size_t kMostAsked = 32;

    explicit Pager(std::unique_ptr<SectorReader> reader);
    ~Pager();  // after the sector at hand, joins

    // In the order in which they are to come. Fewer than kMostAsked are under way.
    void Ask(std::int64_t sector_key);
    // How many were asked for and not taken.
    std::size_t under_way() const { return under_way_; }
    // The next one; null if it is not there yet.
    std::unique_ptr<StoredSector> TryTake();
    // The next one, waited for. Only while one is under way.
    std::unique_ptr<StoredSector> Take();
    // Its storage is used again.
    void Give(std::unique_ptr<StoredSector> sector) { pool_.Give(std::move(sector)); }

  private:
    void ReadAll();

    std::unique_ptr<SectorReader> reader_;  // the thread's
    Wake wake_, owner_wake_;
    Pool<StoredSector> pool_;
    FifoQueue<std::int64_t> asked_{kMostAsked, wake_};
    FifoQueue<std::unique_ptr<StoredSector>> read_{kMostAsked, owner_wake_};
    std::size_t under_way_ = 0;  // the owner's
    std::atomic<bool> done_{false};
    std::jthread thread_;
};

}  // namespace tessera
