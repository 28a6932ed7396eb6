// Kills runs with SIGKILL at random times. Each scan file must open and have lost at most
// the last second, and the resumed run must end with the same result as an uninterrupted run. The
// same is tested with loop closure, in live mode, and with a third of the map paged out.
#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "apps/killed_program.h"
#include "eval/ate.h"
#include "io/trajectory.h"
#include "scan/scan_content.h"

namespace tessera {
namespace {

using testing_support::KilledProgram;

class KilledScan : public KilledProgram {
  protected:
    std::vector<std::string> Arguments(const std::string& out,
                                       const std::vector<std::string>& more) const {
        std::vector<std::string> all{"run",      sequence,
                                     "--frames", std::to_string(frames),
                                     "--out",    out,
                                     "--set",    "mapping.voxel_size_m=0.03",
                                     "--set",    "mapping.truncation_m=0.12"};
        all.insert(all.end(), options.begin(), options.end());
        all.insert(all.end(), more.begin(), more.end());
        return all;
    }
    double Ate(const std::string& out) const {
        const auto truth = ReadTrajectory(sequence + "/groundtruth.txt"),
                   path = ReadTrajectory(out + "/trajectory.txt");
        EXPECT_TRUE(truth.ok() && path.ok()) << truth.message() << path.message();
        if (!truth.ok() || !path.ok()) return 1;
        const auto ate = EvaluateAte(truth.value().poses, path.value().poses, {});
        return ate.ok() ? ate.value().error_m.rmse : 1;
    }
    // Number of frames in the trajectory file.
    static int LinesOf(const std::string& file) {
        std::ifstream lines(file);
        int count = -1;  // the header
        for (std::string line; std::getline(lines, line);) ++count;
        return count;
    }

    void KillAndResume(int times);
    void ExpectSame(const std::string& a, const std::string& b) const {
        for (const char* file : {"/mesh.ply", "/trajectory.txt"})
            EXPECT_TRUE(Bytes(folder / a + file) == Bytes(folder / b + file)) << file;
    }
    // Blocks in memory at the end of the run.
    int BlocksOf(const std::string& run) const {
        const std::string timings = Bytes(folder / run + "/timings.json"), key = "\"blocks\": ";
        const std::size_t at = timings.find(key);
        return at == std::string::npos ? 0 : std::atoi(timings.c_str() + at + key.size());
    }

    int frames = 150;
    std::vector<std::string> options;  // of every run
    bool exact = true;                 // resumed output equals an uninterrupted run's
};

void KilledScan::KillAndResume(int times) {
    const Clock::time_point begin = Clock::now();
    ASSERT_EQ(Call(Arguments(folder / "whole", {"--scan", folder / "whole.scan"})), 0) << Log();
    const double run_s = Seconds(Clock::now() - begin);
    const double unbroken_m = Ate(folder / "whole");
    std::mt19937 random(20250101);
    for (int i = 0; i < times; ++i) {
        const std::string scan = folder / (std::to_string(i) + ".scan"), out = folder / "killed";
        const double kill_s =
            run_s * (0.1 + 0.9 * std::uniform_real_distribution<double>()(random));
        // Otherwise the trajectory of the previous run would be counted.
        std::filesystem::remove_all(out);
        Kill(Arguments(out, {"--scan", scan}), kill_s);
        const int tracked = LinesOf(out + "/trajectory.txt");
        // Killed before the scan file was created.
        if (!std::filesystem::exists(scan)) continue;
        const auto content = ReadScan(scan, {.map = true, .frames = true});
        ASSERT_TRUE(content.ok()) << content.message();
        constexpr int kFramesOfASecond = 30;  // by stamps; fewer by the clock
        EXPECT_GE(static_cast<int>(content.value().path.size()), tracked - kFramesOfASecond)
            << "killed after " << kill_s << " s";
        ASSERT_EQ(Call(Arguments(folder / "resumed", {"--resume", scan})), 0) << Log();
        EXPECT_LE(Ate(folder / "resumed"), 1.1 * unbroken_m) << "killed after " << kill_s << " s";
        EXPECT_EQ(LinesOf(folder / "resumed/trajectory.txt"),
                  LinesOf(folder / "whole/trajectory.txt"));
        if (exact) ExpectSame("resumed", "whole");
        std::filesystem::remove(scan);
    }
}

// TESSERA_KILLS sets the number of kills.
TEST_F(KilledScan, NothingIsLostButTheLastSecond) {
    MakeSequence("desk", frames);
    const char* kills = std::getenv("TESSERA_KILLS");
    KillAndResume(kills != nullptr ? std::atoi(kills) : 4);
}

TEST_F(KilledScan, WithLoopClosure) {
    MakeSequence("desk", frames);
    options = {"--loop-closure", "on"};
    exact = false;
    KillAndResume(3);
}

TEST_F(KilledScan, WithAThirdOfTheMapAway) {
    constexpr int kStride = 4;
    frames = 180;
    MakeSequence("corridor", kStride * frames);
    options = {"--stride", std::to_string(kStride), "--set", "frame.max_depth_m=3"};
    ASSERT_EQ(Call(Arguments(folder / "unlimited", {"--scan", folder / "unlimited.scan"})), 0)
        << Log();
    options.insert(options.end(), {"--set", "mapping.memory_limit_mb=9"});
    KillAndResume(2);
    ExpectSame("unlimited", "whole");
    EXPECT_LT(3 * BlocksOf("whole"), 2 * BlocksOf("unlimited"));
}

// The file must be readable from the moment it has its final name.
TEST_F(KilledScan, AsSoonAsTheFileIsThere) {
    frames = 2;
    sequence = "synthetic:corner";
    options = {"--set", "synthetic.width=64", "--set", "synthetic.height=48",
               "--set", "synthetic.cx=31.5",  "--set", "synthetic.cy=23.5"};
    for (int i = 0; i < 20; ++i) {
        const std::string scan = folder / (std::to_string(i) + ".scan");
        const pid_t child = Start(Arguments(folder / "killed", {"--scan", scan}));
        const Clock::time_point latest = Clock::now() + std::chrono::seconds(60);
        while (!std::filesystem::exists(scan) && Clock::now() < latest) std::this_thread::yield();
        const Clock::time_point there = Clock::now();
        while (Clock::now() < there + std::chrono::microseconds(50 * i)) std::this_thread::yield();
        kill(child, SIGKILL);
        waitpid(child, nullptr, 0);
        const auto content = ReadScan(scan, {.map = true, .frames = true});
        ASSERT_TRUE(content.ok()) << content.message();
    }
}

// Which frames a live run drops depends on thread timing, so the result cannot be compared byte for
// byte. The resumed run must be as accurate as an uninterrupted one.
TEST_F(KilledScan, LiveWithLoopClosure) {
    MakeSequence("desk", frames);
    const std::vector<std::string> live{"--mode", "live", "--loop-closure", "on"};
    for (const double kill_s : {2.3, 4.6}) {
        const std::string scan = folder / "live.scan", out = folder / "live";
        std::vector<std::string> more = live;
        more.insert(more.end(), {"--scan", scan});
        std::filesystem::remove_all(out);
        Kill(Arguments(out, more), kill_s);
        const int tracked = LinesOf(out + "/trajectory.txt");
        if (!std::filesystem::exists(scan)) continue;
        const auto content = ReadScan(scan, {.map = true, .frames = true});
        ASSERT_TRUE(content.ok()) << content.message();
        EXPECT_GE(static_cast<int>(content.value().path.size()), tracked - 30)
            << "killed after " << kill_s << " s";
        more = live;
        more.insert(more.end(), {"--resume", scan});
        ASSERT_EQ(Call(Arguments(folder / "resumed", more)), 0) << Log();
        EXPECT_LE(Ate(folder / "resumed"), 0.01) << "killed after " << kill_s << " s";
        EXPECT_GE(LinesOf(folder / "resumed/trajectory.txt"), tracked - 30);
        std::filesystem::remove(scan);
    }
}

}  // namespace
}  // namespace tessera
