#include "scan/pager.h"

#include "core/check.h"

namespace tessera {

Pager::Pager(std::unique_ptr<SectorReader> reader) : reader_(std::move(reader)), thread_([this] { ReadAll(); }) {}

Pager::~Pager() {
    done_.store(true);
    wake_.Notify();
}

void Pager::Ask(std::int64_t sector_key) {
    TESSERA_CHECK(under_way_ < kMostAsked, "{} sectors under way", under_way_);
    ++under_way_;
    TESSERA_CHECK(asked_.TryPush(std::move(sector_key)), "no room for sector {}", sector_key);
}

std::unique_ptr<StoredSector> Pager::TryTake() {
    std::unique_ptr<StoredSector> sector;
    if (read_.TryPop(sector)) --under_way_;
    return sector;
}

std::unique_ptr<StoredSector> Pager::Take() {
    TESSERA_CHECK(under_way_ > 0, "no sector is under way");
    std::unique_ptr<StoredSector> sector;
    owner_wake_.Wait([&] { return (sector = TryTake()) != nullptr; });
    return sector;
}

void Pager::ReadAll() {
    while (true) {
        std::int64_t key = 0;
        bool got = false;
        wake_.Wait([&] { return done_.load() || (got = asked_.TryPop(key)); });
        if (!got) return;
        std::unique_ptr<StoredSector> sector = pool_.Take();
        sector->key = key;
        sector->status = reader_->Read(key, sector->blocks);
        TESSERA_CHECK(read_.TryPush(std::move(sector)), "no room for sector {}", key);
    }
}

}  // namespace tessera
