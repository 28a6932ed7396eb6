#include "scan/pager.h"

#include "core/check.h"

namespace tessera {

Pager::Pager(std::unique_ptr<CubeReader> reader)
    : reader_(std::move(reader)), worker_(kMostAsked, [this](std::int64_t& key) { Read(key); }) {}

void Pager::Ask(std::int64_t cube_key) {
    TESSERA_CHECK(under_way_ < kMostAsked, "{} cubes under way", under_way_);
    ++under_way_;
    TESSERA_CHECK(worker_.TryPush(std::move(cube_key)), "no room for cube {}", cube_key);
}

std::unique_ptr<StoredCube> Pager::TryTake() {
    std::unique_ptr<StoredCube> cube;
    if (read_.TryPop(cube)) --under_way_;
    return cube;
}

std::unique_ptr<StoredCube> Pager::Take() {
    TESSERA_CHECK(under_way_ > 0, "no cube is under way");
    std::unique_ptr<StoredCube> cube;
    owner_.Wait([&] { return (cube = TryTake()) != nullptr; });
    return cube;
}

void Pager::Read(std::int64_t cube_key) {
    std::unique_ptr<StoredCube> cube = pool_.Take();
    cube->key = cube_key;
    cube->status = reader_->Read(cube_key, cube->blocks);
    TESSERA_CHECK(read_.TryPush(std::move(cube)), "no room for cube {}", cube_key);
}

}  // namespace tessera
