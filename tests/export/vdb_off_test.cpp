#include <gtest/gtest.h>

#include "export/vdb_writer.h"

namespace tessera {
namespace {

TEST(VdbWriter, WithoutOpenVdbItSaysWhatToInstall) {
    EXPECT_FALSE(VdbAvailable());
    const BlockMap map(BlockMap::Config{});
    EXPECT_EQ(WriteVdb("a.vdb", map).message(),
              "a.vdb: .vdb is not in this build: install libopenvdb-dev and build again");
}

}  // namespace
}  // namespace tessera
