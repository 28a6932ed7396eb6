// Kills merges of two scans with SIGKILL at random times.
#include <gtest/gtest.h>

#include <filesystem>
#include <random>

#include "apps/killed_program.h"
#include "scan/scan_content.h"

namespace tessera {
namespace {

class KilledMerge : public testing_support::KilledProgram {
  protected:
    std::string Scan(const std::string& name, int first, int count) const {
        const std::string scan = folder / name;
        EXPECT_EQ(Call({"run", sequence, "--start", std::to_string(first), "--frames",
                        std::to_string(count), "--out", folder / "run", "--scan", scan, "--set",
                        "mapping.voxel_size_m=0.03", "--set", "mapping.truncation_m=0.12"}),
                  0)
            << Log();
        return scan;
    }
};

// Both scans stay as they are, the merged one is whole or not there, and a second attempt succeeds.
// TESSERA_KILLS sets the number of kills.
TEST_F(KilledMerge, LeavesWhatWasThere) {
    MakeSequence("room", 300);
    const std::string a = Scan("a.scan", 0, 180), b = Scan("b.scan", 120, 180),
                      merged = folder / "merged.scan", whole = folder / "whole.scan";
    const std::string a_bytes = Bytes(a), b_bytes = Bytes(b);
    const Clock::time_point begin = Clock::now();
    ASSERT_EQ(Call({"scan", "merge", a, b, "--out", whole}), 0) << Log();
    const double merge_s = Seconds(Clock::now() - begin);
    const std::vector<std::string> merge{"scan", "merge", a, b, "--out", merged};
    const auto expect_whole = [&] {
        const auto content = ReadScan(merged, {.map = true, .frames = true}),
                   expected = ReadScan(whole, {.map = true, .frames = true});
        ASSERT_TRUE(content.ok() && expected.ok()) << content.message() << expected.message();
        EXPECT_EQ(content.value().Path().size(), expected.value().Path().size());
        EXPECT_EQ(content.value().frames.size(), expected.value().frames.size());
        EXPECT_EQ(content.value().map->count(), expected.value().map->count());
    };
    const char* kills = std::getenv("TESSERA_KILLS");
    std::mt19937 random(20261130);
    for (int i = 0; i < (kills != nullptr ? std::atoi(kills) : 6); ++i) {
        const double kill_s = merge_s * (0.05 + std::uniform_real_distribution<double>()(random));
        SCOPED_TRACE("killed after " + std::to_string(kill_s) + " s");
        std::filesystem::remove(merged);
        Kill(merge, kill_s);
        EXPECT_TRUE(Bytes(a) == a_bytes && Bytes(b) == b_bytes);
        if (std::filesystem::exists(merged)) expect_whole();
    }
    std::filesystem::remove(merged);
    ASSERT_EQ(Call(merge), 0) << Log();
    expect_whole();
    EXPECT_FALSE(std::filesystem::exists(merged + ".part"));
}

}  // namespace
}  // namespace tessera
