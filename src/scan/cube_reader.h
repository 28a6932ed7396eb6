// Reads single cubes of a scan file, also while its writer goes on: each cube as the last
// checkpoint left it.
#pragma once

#include <memory>
#include <string>

#include "scan/block_codec.h"
#include "scan/cube.h"
#include "scan/database.h"

namespace tessera {

// Owner thread only; may be handed from one to another.
class CubeReader {
  public:
    // A file that this process writes, or has read before: its header is not looked at again.
    static Result<std::unique_ptr<CubeReader>> Open(const std::string& path);

    // All blocks of a cube, by increasing key; perhaps none; their numbers are at least 1. An error
    // names the file, `blocks` is then of no use.
    Status Read(std::int64_t cube_key, BlockCopies& blocks);

    // The keys of all cubes that have blocks, increasing, with how many.
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
