// Reads single cubes of a scan file, even while its writer is active. Each cube is as of the last
// checkpoint.
#pragma once

#include <memory>
#include <string>

#include "scan/block_codec.h"
#include "scan/cube.h"
#include "scan/database.h"

namespace tessera {

// Owner thread only; ownership may move between threads.
class CubeReader {
  public:
    // The file must be written by this process or have been read before: its header is not checked
    // again.
    static Result<std::unique_ptr<CubeReader>> Open(const std::string& path);

    // Reads all blocks of a cube, by increasing key; there may be none. Their numbers are at least
    // 1. Errors name the file; `blocks` is then invalid.
    Status Read(std::int64_t cube_key, BlockCopies& blocks);

    // Returns the keys of all cubes that have blocks, in increasing order, with their block counts.
    Result<std::vector<std::pair<std::int64_t, std::int32_t>>> Cubes();

    const std::string& path() const { return database_->path(); }

  private:
    CubeReader(std::unique_ptr<Database> database, DatabaseStatement select)
        : database_(std::move(database)), select_(std::move(select)) {}

    Status ReadError() const;

    std::unique_ptr<Database> database_;
    DatabaseStatement select_;
    BlockCodec codec_;
};

}  // namespace tessera
