// Where the cubes of a map go that is not the scan's yet: a file without a name in the scan's
// folder, gone with the process. Its rows are those of the scan file, which takes them as they are.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>

#include "scan/block_codec.h"
#include "scan/cube.h"

namespace tessera {

// Owner thread only; a const one may be read by several.
class CubeScratch {
  public:
    // Errors name the file beside which it is to be, what is wrong and what to do.
    static Result<std::shared_ptr<CubeScratch>> Create(const std::string& beside_path);
    ~CubeScratch();
    CubeScratch(const CubeScratch&) = delete;
    CubeScratch& operator=(const CubeScratch&) = delete;

    // All blocks of a cube, in place of what it had.
    Status Put(std::int64_t cube_key, const BlockCopies& blocks);
    // As they were put; checked. Blocks by increasing key.
    Status Read(std::int64_t cube_key, BlockCopies& blocks) const;
    // Cubes by increasing key, with how many blocks.
    std::map<std::int64_t, std::int32_t> Cubes() const;
    // Of a cube that is there; 0: it is not.
    std::int32_t Count(std::int64_t cube_key) const;
    // Every block's row of ScanTable::kBlocks, by increasing key.
    using TakeRow =
        std::function<Status(std::int64_t block_key, std::span<const std::uint8_t> data)>;
    Status ForEachRow(const TakeRow& take) const;

  private:
    struct Place {
        std::uint64_t offset = 0, room = 0, bytes = 0, checksum = 0;
        std::int32_t blocks = 0;
    };

    CubeScratch(int file, std::string beside_path) : file_(file), path_(std::move(beside_path)) {}

    Place Room(std::uint64_t bytes);
    Status ReadRows(const Place& place, std::vector<std::uint8_t>& rows, const TakeRow& take) const;
    Status Error(const std::string& doing, int error) const;

    int file_;
    std::string path_;
    std::map<std::int64_t, Place> places_;
    std::multimap<std::uint64_t, std::uint64_t> free_;  // room to offset
    std::uint64_t end_ = 0;
    BlockCodec codec_;
    std::vector<std::uint8_t> rows_;
};

}  // namespace tessera
