#include "core/memory.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "support/temp_folder.h"

namespace tessera {
namespace {

class FreeMemory : public testing::Test {
  protected:
    FreeMemory() {
        Put("proc/meminfo", "MemTotal: 9 kB\nMemFree: 1024 kB\nMemAvailable: 8192000 kB\n");
    }
    void Put(const std::string& name, const std::string& text) const {
        const std::filesystem::path path = folder_ / name;
        std::filesystem::create_directories(path.parent_path());
        std::ofstream(path) << text;
    }
    double Mb() const { return FreeMemoryMb(folder_.path()); }

    TempFolder folder_;
};

TEST_F(FreeMemory, IsWhatTheMachineHasWithoutALimit) { EXPECT_EQ(Mb(), 8000); }

TEST_F(FreeMemory, TheTightestControlGroupCounts) {
    Put("proc/self/cgroup", "0::/a/b\n");
    Put("sys/fs/cgroup/a/b/memory.max", "max\n");
    Put("sys/fs/cgroup/a/b/memory.current", "1048576\n");
    EXPECT_EQ(Mb(), 8000);
    Put("sys/fs/cgroup/a/memory.max", "1073741824\n");
    Put("sys/fs/cgroup/a/memory.current", "209715200\n");
    Put("sys/fs/cgroup/a/memory.stat", "anon 5\ninactive_file 104857600\n");
    EXPECT_EQ(Mb(), 1024 - 200 + 100);
}

TEST_F(FreeMemory, InAContainerItsOwnGroupIsTheRoot) {
    Put("proc/self/cgroup", "0::/\n");
    Put("sys/fs/cgroup/memory.max", "536870912\n");
    Put("sys/fs/cgroup/memory.current", "104857600\n");
    EXPECT_EQ(Mb(), 412);
}

TEST_F(FreeMemory, ControlGroupsOfTheFirstVersion) {
    Put("proc/self/cgroup", "5:cpu:/x\n4:memory:/docker/1\n");
    Put("sys/fs/cgroup/memory/memory.limit_in_bytes", "536870912\n");
    Put("sys/fs/cgroup/memory/memory.usage_in_bytes", "104857600\n");
    Put("sys/fs/cgroup/memory/memory.stat", "cache 1\ntotal_inactive_file 1048576\n");
    EXPECT_EQ(Mb(), 413);
}

TEST_F(FreeMemory, TheProcessCanHaveALimitOfItsOwn) {
    Put("proc/self/statm", "100000 2560 1\n");
    SetMemoryLimit(100);
    EXPECT_EQ(Mb(), 90);  // pages of 4 kB
    SetMemoryLimit(0);
    EXPECT_EQ(Mb(), 8000);
}

TEST(FreeMemoryHere, IsThere) {
    EXPECT_GT(FreeMemoryMb(), 1);
    EXPECT_LT(FreeMemoryMb(), 1e8);
}

}  // namespace
}  // namespace tessera
