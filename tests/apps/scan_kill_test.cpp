// kill -9 at twenty random moments of a run: each file opens, has lost at most the last second, and the run that goes on
// with it ends as the unbroken one. The same with loop closure on.
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "eval/ate.h"
#include "io/trajectory.h"
#include "scan/scan_content.h"
#include "support/temp_folder.h"

namespace tessera {
namespace {

using Clock = std::chrono::steady_clock;

double Seconds(Clock::duration duration) { return std::chrono::duration<double>(duration).count(); }

class KilledScan : public testing::Test {
  protected:
    static constexpr int kFrames = 150;

    std::vector<std::string> Arguments(const std::string& out, const std::vector<std::string>& more) const {
        std::vector<std::string> all{"run", sequence, "--frames", std::to_string(kFrames), "--out", out,
                                     "--set", "mapping.voxel_size_m=0.03", "--set", "mapping.truncation_m=0.12"};
        all.insert(all.end(), more.begin(), more.end());
        return all;
    }
    pid_t Start(const std::vector<std::string>& arguments) const {
        std::vector<char*> argv{const_cast<char*>(TESSERA_PROGRAM)};
        for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
        argv.push_back(nullptr);
        const pid_t child = fork();
        if (child == 0) {
            const std::string log = folder / "log";
            if (std::freopen(log.c_str(), "a", stdout) == nullptr || std::freopen(log.c_str(), "a", stderr) == nullptr) _exit(99);
            execv(TESSERA_PROGRAM, argv.data());
            _exit(98);
        }
        return child;
    }
    static int WaitFor(pid_t child) {
        int status = 0;
        waitpid(child, &status, 0);
        return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    }
    int Call(const std::vector<std::string>& arguments) const { return WaitFor(Start(arguments)); }
    double Ate(const std::string& out) const {
        const auto truth = ReadTrajectory(sequence + "/groundtruth.txt"), path = ReadTrajectory(out + "/trajectory.txt");
        EXPECT_TRUE(truth.ok() && path.ok()) << truth.message() << path.message();
        if (!truth.ok() || !path.ok()) return 1;
        const auto ate = EvaluateAte(truth.value().poses, path.value().poses, {});
        return ate.ok() ? ate.value().error_m.rmse : 1;
    }
    // Frames of which the run had written the trajectory's line by then.
    static int LinesOf(const std::string& file) {
        std::ifstream lines(file);
        int count = -1;  // the header
        for (std::string line; std::getline(lines, line);) ++count;
        return count;
    }
    std::string Log() const {
        std::stringstream text;
        text << std::ifstream(folder / "log").rdbuf();
        return text.str();
    }

    void MakeSequence() const {
        ASSERT_EQ(Call({"synth", "desk", "--out", sequence, "--frames", std::to_string(kFrames), "--noise", "kinect", "--set",
                        "synthetic.width=320", "--set", "synthetic.height=240", "--set", "synthetic.fx=262.5", "--set",
                        "synthetic.fy=262.5", "--set", "synthetic.cx=159.5", "--set", "synthetic.cy=119.5"}), 0) << Log();
    }
    void KillAndResume(const std::string& loops, int times);

    TempFolder folder;
    std::string sequence = folder / "desk";
};

void KilledScan::KillAndResume(const std::string& loops, int times) {
    MakeSequence();
    const Clock::time_point begin = Clock::now();
    ASSERT_EQ(Call(Arguments(folder / "whole", {"--loop-closure", loops})), 0) << Log();
    const double run_s = Seconds(Clock::now() - begin);
    const double unbroken_m = Ate(folder / "whole");
    std::mt19937 random(20250101);
    for (int i = 0; i < times; ++i) {
        const std::string scan = folder / (std::to_string(i) + ".scan"), out = folder / "killed";
        const double kill_s = run_s * (0.1 + 0.9 * std::uniform_real_distribution<double>()(random));
        std::filesystem::remove_all(out);  // or the trajectory of the run before counts as this one's
        const Clock::time_point start = Clock::now();
        const pid_t child = Start(Arguments(out, {"--scan", scan, "--loop-closure", loops}));
        std::this_thread::sleep_until(start + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(kill_s)));
        kill(child, SIGKILL);
        waitpid(child, nullptr, 0);
        const int tracked = LinesOf(out + "/trajectory.txt");
        if (!std::filesystem::exists(scan)) continue;  // killed before it began: nothing was scanned
        const auto content = ReadScan(scan, {.map = true, .frames = true});
        ASSERT_TRUE(content.ok()) << content.message();
        constexpr int kFramesOfASecond = 30;  // of stamps; by the clock it is less
        EXPECT_GE(static_cast<int>(content.value().path.size()), tracked - kFramesOfASecond) << "killed after " << kill_s << " s";
        ASSERT_EQ(Call(Arguments(folder / "resumed", {"--resume", scan})), 0) << Log();
        EXPECT_LE(Ate(folder / "resumed"), 1.1 * unbroken_m) << "killed after " << kill_s << " s";
        EXPECT_EQ(LinesOf(folder / "resumed/trajectory.txt"), LinesOf(folder / "whole/trajectory.txt"));
        std::filesystem::remove(scan);
    }
}

TEST_F(KilledScan, TwentyTimesNothingIsLostButTheLastSecond) { KillAndResume("off", 20); }

TEST_F(KilledScan, WithLoopClosure) { KillAndResume("on", 5); }

// Which frames a live run drops, its threads decide: it is as accurate as a run without interruption can be.
TEST_F(KilledScan, LiveWithLoopClosure) {
    MakeSequence();
    const std::vector<std::string> live{"--mode", "live", "--loop-closure", "on"};
    for (const double kill_s : {2.3, 3.1, 4.6}) {
        const std::string scan = folder / "live.scan", out = folder / "live";
        std::vector<std::string> more = live;
        more.insert(more.end(), {"--scan", scan});
        std::filesystem::remove_all(out);
        const pid_t child = Start(Arguments(out, more));
        std::this_thread::sleep_for(std::chrono::duration<double>(kill_s));
        kill(child, SIGKILL);
        waitpid(child, nullptr, 0);
        const int tracked = LinesOf(out + "/trajectory.txt");
        if (!std::filesystem::exists(scan)) continue;
        const auto content = ReadScan(scan, {.map = true, .frames = true});
        ASSERT_TRUE(content.ok()) << content.message();
        EXPECT_GE(static_cast<int>(content.value().path.size()), tracked - 30) << "killed after " << kill_s << " s";
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
