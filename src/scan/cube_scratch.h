// Temporary storage for the cubes of a map that is not yet the scan's map: an unlinked file in the
// scan's folder that disappears with the process. Its rows have the format of the scan file, which
// copies them unchanged.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>

#include "io/temporary_file.h"
#include "scan/block_codec.h"
#include "scan/cube.h"

namespace tessera {

// Owner thread only; several threads may read a const object.
class CubeScratch {
  public:
    // Creates the file next to `beside_path`. Errors name that path, what is wrong and what to do.
    static Result<std::shared_ptr<CubeScratch>> Create(const std::string& beside_path);

    // Stores all blocks of a cube and replaces its previous blocks.
    Status Put(std::int64_t cube_key, const BlockCopies& blocks);
    // Returns the blocks as stored, checked against the checksum, by increasing key.
    Status Read(std::int64_t cube_key, BlockCopies& blocks) const;
    // Cubes by increasing key, with their block counts.
    std::map<std::int64_t, std::int32_t> Cubes() const;
    // Number of blocks of a cube; 0 if the cube is not stored.
    std::int32_t Count(std::int64_t cube_key) const;
    // Visits every block's row of ScanTable::kBlocks, cube by cube, by increasing key.
    using TakeRow =
        std::function<Status(std::int64_t block_key, std::span<const std::uint8_t> data)>;
    Status ForEachRow(const TakeRow& take) const;

  private:
    struct Place {
        std::uint64_t offset = 0, room = 0, bytes = 0, checksum = 0;
        std::int32_t blocks = 0;
    };

    CubeScratch(std::shared_ptr<TemporaryFile> file, std::string beside_path)
        : file_(std::move(file)), path_(std::move(beside_path)) {}

    Place Room(std::uint64_t bytes);
    Status ReadRows(const Place& place, std::vector<std::uint8_t>& rows, const TakeRow& take) const;
    Status Error(const std::string& what) const;

    std::shared_ptr<TemporaryFile> file_;
    std::string path_;
    std::map<std::int64_t, Place> places_;
    std::multimap<std::uint64_t, std::uint64_t> free_;  // capacity to offset
    std::uint64_t end_ = 0;
    BlockCodec codec_;
    std::vector<std::uint8_t> rows_;
};

}  // namespace tessera
