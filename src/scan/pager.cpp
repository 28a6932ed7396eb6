#include "scan/pager.h"

#include "core/check.h"

namespace tessera {

Pager::Pager(std::unique_ptr<CubeReader> reader)
    : reader_(std::move(reader)), thread_([this] { ReadAll(); }) {}

Pager::~Pager() {
    done_.store(true);
    wake_.Notify();
}

void Pager::Ask(std::int64_t cube_key) {
    TESSERA_CHECK(under_way_ < kMostAsked, "{} cubes under way", under_way_);
    ++under_way_;
    TESSERA_CHECK(asked_.TryPush(std::move(cube_key)), "no room for cube {}", cube_key);
}

std::unique_ptr<StoredCube> Pager::TryTake() {
    std::unique_ptr<StoredCube> cube;
    if (read_.TryPop(cube)) --under_way_;
    return cube;
}

std::unique_ptr<StoredCube> Pager::Take() {
    TESSERA_CHECK(under_way_ > 0, "no cube is under way");
    std::unique_ptr<StoredCube> cube;
    owner_wake_.Wait([&] { return (cube = TryTake()) != nullptr; });
    return cube;
}

void Pager::ReadAll() {
    while (true) {
        std::int64_t key = 0;
        bool got = false;
        wake_.Wait([&] { return done_.load() || (got = asked_.TryPop(key)); });
        if (!got) return;
        std::unique_ptr<StoredCube> cube = pool_.Take();
        cube->key = key;
        cube->status = reader_->Read(key, cube->blocks);
        TESSERA_CHECK(read_.TryPush(std::move(cube)), "no room for cube {}", key);
    }
}

}  // namespace tessera
