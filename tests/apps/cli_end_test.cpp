// Runs that end early: by signals, a full disk or a lack of memory. Also runs beside another one.
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>

#include "apps/cli_fixture.h"
#include "io/mesh_io.h"
#include "io/trajectory.h"

namespace tessera {
namespace {

TEST_F(Cli, ADiskThatIsFullIsNamed) {
    // ulimit limits files to 32 blocks of 512 bytes: enough for run.json, not for the mesh. This
    // acts like a full disk and needs no privileges.
    const std::string limited = "sh -c 'ulimit -f 32; exec " TESSERA_PROGRAM " \"$@\"' sh ";
    const std::string command = limited + SmallRun() + "--frames 5 --out " + (folder / "o") +
                                " 2>" + (folder / "stderr") + " >/dev/null </dev/null";
    const int status = std::system(command.c_str());
    EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 2) << status;
    EXPECT_NE(ReadAll(folder / "stderr").find("mesh.ply"), std::string::npos)
        << ReadAll(folder / "stderr");
    const auto trajectory = ReadTrajectory(folder / "o/trajectory.txt");  // kept
    EXPECT_TRUE(trajectory.ok()) << trajectory.message();
}

// Starts a run of many seconds. Returns once frames are being tracked.
pid_t StartLongRun(const std::string& arguments, const std::string& out) {
    const pid_t child = fork();
    if (child == 0) {
        (void)!freopen("/dev/null", "w", stdout);
        (void)!freopen("/dev/null", "w", stderr);
        const std::string command = "exec " + arguments + " --out " + out;
        execl("/bin/sh", "sh", "-c", command.c_str(), nullptr);
        _exit(127);
    }
    const auto lines = [&] {
        const std::string text = ReadAll(out + "/trajectory.txt");
        return std::count(text.begin(), text.end(), '\n');
    };
    while (lines() < 3)
        if (waitpid(child, nullptr, WNOHANG) != 0) {
            ADD_FAILURE() << "ended before it could be stopped";
            return -1;
        }
    return child;
}

// The first signal ends a run within two seconds, and all output is written.
TEST_F(Cli, ASignalEndsTheRunWithEverythingWritten) {
    for (const auto& [signal_number, mode] : {std::pair{SIGTERM, "lockstep"},
                                              {SIGINT, "lockstep"},
                                              {SIGHUP, "lockstep"},
                                              {SIGTERM, "live"},
                                              {SIGINT, "live"}}) {
        const std::string out = folder / (mode + std::to_string(signal_number));
        const pid_t child = StartLongRun(std::string(TESSERA_PROGRAM) + " " + SmallRun() +
                                             "--set synthetic.speed=0.1 --mode " + mode,
                                         out);
        ASSERT_GT(child, 0);
        kill(child, signal_number);
        int status = 0;
        ASSERT_EQ(waitpid(child, &status, 0), child);
        EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << status;
        EXPECT_NE(ReadAll(out + "/run.json").find("\"stopped\""), std::string::npos);
        EXPECT_TRUE(std::filesystem::exists(out + "/mesh.ply"));
    }
}

// Whichever thread it happens on, and whatever asked for the memory.
TEST_F(Cli, OutOfMemoryIsOneLine) {
    for (const int limit_mb : {100, 200, 300}) {
        const std::string within = "ulimit -d " + std::to_string(1000 * limit_mb) + "; ";
        const Outcome outcome = Call(SmallRun() + "--out " + (folder / "o"), within);
        EXPECT_EQ(outcome.exit_code, 2) << outcome.err;
        EXPECT_NE(outcome.err.find("tessera: out of memory; what was written so far is kept"),
                  std::string::npos)
            << outcome.err;
    }
}

TEST_F(Cli, ARunEndsInOrderBeforeMemoryIsUsedUp) {
    const std::string small_voxels =
        "--set mapping.voxel_size_m=0.01 --set mapping.truncation_m=0.04 --set synthetic.speed=4 ";
    const Outcome run = Call(
        "run synthetic:room --loop-closure off --set run.memory_limit_mb=750 "
        "--mode lockstep --frames 300 " +
        small_voxels + "--out " + (folder / "o"));
    EXPECT_EQ(run.exit_code, 0) << run.err;
    EXPECT_NE(run.err.find("are free last for about"), std::string::npos) << run.err;
    EXPECT_NE(run.err.find("memory is nearly used up"), std::string::npos) << run.err;
    const auto trajectory = ReadTrajectory(folder / "o/trajectory.txt");
    ASSERT_TRUE(trajectory.ok()) << trajectory.message();
    EXPECT_GT(trajectory.value().poses.size(), 5u);
    EXPECT_LT(trajectory.value().poses.size(), 300u);
    EXPECT_TRUE(ReadPly(folder / "o/mesh.ply").ok());
    const auto run_json = nlohmann::json::parse(ReadAll(folder / "o/run.json"));
    EXPECT_EQ(run_json["exit"], "stopped");
    EXPECT_LT(nlohmann::json::parse(ReadAll(folder / "o/timings.json"))["peak_rss_mb"], 750);
}

TEST_F(Cli, TheSameSignalAgainEndsAtOnceAndTheScanIsWhole) {
    const std::string scan = folder / "a.scan";
    const pid_t child = StartLongRun(std::string(TESSERA_PROGRAM) + " " + SmallRun() +
                                         "--set synthetic.speed=0.1 --scan " + scan,
                                     folder / "o");
    ASSERT_GT(child, 0);
    kill(child, SIGINT);
    kill(child, SIGINT);
    int status = 0;
    ASSERT_EQ(waitpid(child, &status, 0), child);
    // The two may arrive as one.
    EXPECT_TRUE(WIFSIGNALED(status) || WEXITSTATUS(status) == 0) << status;
    if (!std::filesystem::exists(scan)) return;  // ended before the first checkpoint
    const Outcome info = Call("info " + scan);
    EXPECT_EQ(info.exit_code, 0) << info.err;
}

TEST_F(Cli, ASecondProgramCannotWriteIntoTheScan) {
    const std::string scan = folder / "a.scan";
    const pid_t child = StartLongRun(std::string(TESSERA_PROGRAM) + " " + SmallRun() +
                                         "--set synthetic.speed=0.1 --scan " + scan,
                                     folder / "o");
    ASSERT_GT(child, 0);
    ExpectRefused(SmallRun() + "--resume " + scan, "another run is writing to it");
    ExpectRefused(SmallRun() + "--scan " + scan, "already exists");
    EXPECT_EQ(Call("info " + scan).exit_code, 0);
    kill(child, SIGINT);
    int status = 0;
    ASSERT_EQ(waitpid(child, &status, 0), child);
    EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << status;
    EXPECT_EQ(Call("info " + scan).exit_code, 0);
}

TEST_F(Cli, ARunOutlivesItsTerminalAndWhoeverReadsItsMessages) {
    const pid_t child = StartLongRun("nohup " + std::string(TESSERA_PROGRAM) + " " + SmallRun() +
                                         "--frames 400 --set synthetic.speed=0.1",
                                     folder / "o");
    ASSERT_GT(child, 0);
    kill(child, SIGHUP);
    int status = 0;
    ASSERT_EQ(waitpid(child, &status, 0), child);
    EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << status;
    EXPECT_NE(ReadAll(folder / "o/run.json").find("\"finished\""), std::string::npos);
    const std::string command = std::string("(") + TESSERA_PROGRAM + " " + SmallRun() +
                                "--frames 20 --out " + (folder / "p") + "; echo $? >" +
                                (folder / "code") + ") 2>&1 | true";
    (void)!std::system(command.c_str());
    EXPECT_EQ(ReadAll(folder / "code"), "0\n");
    EXPECT_NE(ReadAll(folder / "p/run.json").find("\"finished\""), std::string::npos);
}

}  // namespace
}  // namespace tessera
