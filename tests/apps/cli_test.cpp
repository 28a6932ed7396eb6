// Tests the contract of docs/design.md, section 8: options, exit codes, one line on stderr.
#include <signal.h>
#include <unistd.h>

#include <nlohmann/json.hpp>

#include "apps/cli_fixture.h"
#include "io/image_io.h"
#include "io/mesh_io.h"
#include "io/trajectory.h"

namespace tessera {
namespace {

TEST_F(Cli, LiveRunsAndRecordsAndTheRecordingRunsAgain) {
    const Outcome live = Call(SmallRun() + "--frames 12 --mode live --record " + (folder / "raw") +
                              " --out " + (folder / "out"));
    EXPECT_EQ(live.exit_code, 0) << live.err;
    EXPECT_NE(live.out.find("live: "), std::string::npos) << live.out;
    EXPECT_NE(live.err.find("recorded 12 frames in " + (folder / "raw")), std::string::npos)
        << live.err;
    const Outcome again = Call("run " + (folder / "raw") + " --out " + (folder / "again"));
    EXPECT_EQ(again.exit_code, 0) << again.err;
    EXPECT_NE(again.out.find("12 frames, 12 tracked"), std::string::npos) << again.out;
}

TEST_F(Cli, WithoutADisplayViewSaysSoAndGoesOn) {
    const Outcome outcome = Call(SmallRun() + "--frames 5 --view --out " + (folder / "out"),
                                 "env -u DISPLAY -u WAYLAND_DISPLAY ");
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_NE(outcome.err.find("continuing without"), std::string::npos) << outcome.err;
    EXPECT_NE(outcome.out.find("5 frames, 5 tracked"), std::string::npos) << outcome.out;
}

TEST_F(Cli, AWholeRunInAWindow) {
    if (std::system("command -v xvfb-run >/dev/null") != 0)
        GTEST_SKIP() << "no xvfb-run: apt-get install xvfb";
    for (const std::string mode : {"lockstep", "live"}) {
        const Outcome outcome =
            Call(SmallRun() + "--frames 12 --view --set view.close_at_end=true --mode " + mode +
                     " --out " + (folder / mode),
                 "xvfb-run -a ");
        EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
        EXPECT_EQ(outcome.err.find("no window"), std::string::npos) << outcome.err;
        EXPECT_FALSE(ReadAll(folder / (mode + "/mesh.ply")).empty());
    }
}

TEST_F(Cli, HelpEverywhere) {
    for (const char* command :
         {"",           "run",         "eval",        "eval ate",        "eval rpe",
          "eval drift", "eval mesh",   "eval labels", "eval detections", "synth",
          "sweep",      "sweep alpha", "render",      "objects",         "view",
          "info",       "doctor",      "config",      "scan repair",     "scan merge"})
        EXPECT_NE(Succeeds(std::string(command) + " -h").find("--help"), std::string::npos)
            << command;
    EXPECT_EQ(Succeeds("eval --help"), Succeeds("eval -h"));
    EXPECT_EQ(Call("--version").out.rfind("tessera ", 0), 0u);
}

// Refused before the run starts, so nothing is written.
TEST_F(Cli, LabelsThatCannotBeAreRefused) {
    const auto refused = [&](const std::string& name, const std::string& content,
                             const std::string& named) {
        std::ofstream(folder / name) << content;
        ExpectRefused("run synthetic:desk --out " + (folder / "o") + " --labels " + (folder / name),
                      named);
    };
    ExpectRefused("run synthetic:desk --out " + (folder / "o") + " --labels /no/such.txt",
                  "/no/such.txt");
    refused("empty.txt", "", "empty.txt");
    refused("five.txt", "1000 cup 0.9 1 1\n", "five.txt:1: ");
    refused("nan.txt", "1000 cup 0.9 1 1 5 5\n1000 cup nan 1 1 5 5\n", "nan.txt:2: ");
    refused("turned.txt", "1000 cup 0.9 5 5 1 1\n", "turned.txt:1: ");
    refused("cut.onnx", "\x08\x07\x3a\x70", "cut.onnx");
    refused("a.cfg", "[net]\n", "a.weights");
    EXPECT_FALSE(std::filesystem::exists(folder / "o"));
}

TEST_F(Cli, AMeshWithoutLabelsIsNotShownByLabel) {
    ASSERT_EQ(Call(SmallRun() + "--frames 3 --out " + (folder / "o")).exit_code, 0);
    ExpectRefused(
        "render " + (folder / "o/mesh.ply") + " --shading label --out " + (folder / "p.png"),
        "has no labels");
    ExpectRefused("objects " + (folder / "o") + " --out " + (folder / "parts"), "has no labels");
}

TEST_F(Cli, BadArgumentsAreOneLineAndExitCode2) {
    ExpectRefused("", "subcommand");
    ExpectRefused("rnu synthetic:desk", "did you mean run?");
    ExpectRefused("xxxxxx", "unknown command or option 'xxxxxx' (tessera -h lists them)");
    ExpectRefused("run realsense:", "realsense: is not a kind of source; cameras without OpenNI2");
    ExpectRefused("run gopher:desk", "pipe:- or synthetic:NAME");
    ExpectRefused("walk", "walk");
    ExpectRefused("run", "SOURCE");
    ExpectRefused("run synthetic:desk --nonsense", "--nonsense");
    ExpectRefused("run synthetic:desk --frames 0", "--frames");
    ExpectRefused("run synthetic:desk --stride -1", "--stride");
    ExpectRefused("run synthetic:desk --threads x", "--threads");
    ExpectRefused("run synthetic:desk --tracker orb", "--tracker");
    ExpectRefused("run synthetic:desk --alpha 1e9", "alpha");
    ExpectRefused("run synthetic:desk --set mapping.voxel_size=1", "mapping.voxel_size_m");
    ExpectRefused("run synthetic:desk --set voxels", "KEY=VALUE");
    ExpectRefused("run synthetic:desk --config nowhere.yaml", "nowhere.yaml");
    ExpectRefused("run synthetic:nowhere --out " + (folder / "o"), "nowhere");
    ExpectRefused("run /no/such/folder --out " + (folder / "o"), "/no/such/folder");
    ExpectRefused("run synthetic:desk --out /proc/no", "/proc/no");
    ExpectRefused("eval ate /no/reference.txt /no/estimate.txt", "/no/reference.txt");
    ExpectRefused("eval drift /no/reference.txt /no/estimate.txt", "/no/reference.txt");
    ExpectRefused("eval mesh /no/a.ply /no/b.ply", "/no/a.ply");
    ExpectRefused("eval detections /no/desk /no/detections.txt", "/no/desk");
    ExpectRefused("eval detections /no/desk /no/detections.txt --aliases tv", "--aliases: 'tv'");
    ExpectRefused("render /no/a.ply --out a.png", "/no/a.ply");
    ExpectRefused("objects /no/such/run --out " + (folder / "o"), "/no/such/run/objects.json");
    ExpectRefused("view /no/such/run", "/no/such/run");
    ExpectRefused("view synthetic:desk", "tessera run synthetic:desk --view");
    ExpectRefused("view " + folder.path(), "mesh.ply");
    ExpectRefused("sweep alpha synthetic:desk --values 1:0:1", "--values");
    ExpectRefused("sweep alpha synthetic:desk --values 0:1:0", "--values");
    ExpectRefused("info /no/such/folder", "/no/such/folder");
}

TEST_F(Cli, AGpuThatIsAskedForByNameAndIsNotThereIsRefused) {
    if (Call("doctor").out.find("compute capability") != std::string::npos)
        GTEST_SKIP() << "this machine has a GPU";
    ExpectRefused("run synthetic:desk --device cuda", "--device cuda");
}

TEST_F(Cli, AScanIsSavedLookedAtGoneOnWithHandedOutAndRepaired) {
    const std::string scan = folder / "a.scan";
    EXPECT_EQ(Call(SmallRun() + "--loop-closure off --frames 12 --out " + (folder / "first") +
                   " --scan " + scan)
                  .exit_code,
              0);
    ExpectRefused(SmallRun() + "--frames 12 --out " + (folder / "x") + " --scan " + scan,
                  "--resume");
    ExpectRefused(SmallRun() + "--set mapping.voxel_size_m=0.05 --resume " + scan,
                  "mapping.voxel_size_m");
    ExpectRefused(SmallRun() + "--loop-closure on --resume " + scan, "loops.enabled");
    const Outcome info = Call("info " + scan);
    EXPECT_EQ(info.exit_code, 0) << info.err;
    EXPECT_NE(info.out.find("complete"), std::string::npos) << info.out;
    EXPECT_NE(info.out.find("12 frames, 12 tracked"), std::string::npos) << info.out;
    const Outcome resumed =
        Call(SmallRun() + "--frames 20 --out " + (folder / "second") + " --resume " + scan);
    EXPECT_NE(resumed.out.find("8 frames, 8 tracked"), std::string::npos)
        << resumed.out << resumed.err;
    EXPECT_EQ(ReadTrajectory(folder / "second/trajectory.txt").value().poses.size(), 20u);
    EXPECT_EQ(Call("export " + scan + " --mesh " + (folder / "m.ply") + " --trajectory " +
                   (folder / "t.txt"))
                  .exit_code,
              0);
    EXPECT_EQ(ReadAll(folder / "m.ply"), ReadAll(folder / "second/mesh.ply"));
    EXPECT_EQ(ReadTrajectory(folder / "t.txt").value().poses.size(), 20u);
    ExpectRefused("export " + scan + " --frames " + (folder / "raw"), "scan.frames=all");
    ExpectRefused("run " + scan, "scan.frames=all");
    ExpectRefused("info " + (folder / "m.ply") + ".scan", "no such file");
    std::filesystem::resize_file(scan, std::filesystem::file_size(scan) / 2);
    ExpectRefused("info " + scan, "tessera scan repair");
    const Outcome repaired = Call("scan repair " + scan + " --out " + (folder / "b.scan"));
    EXPECT_EQ(repaired.exit_code, 0) << repaired.err;
    EXPECT_NE(repaired.out.find("lost:"), std::string::npos) << repaired.out;
    EXPECT_EQ(Call("info " + (folder / "b.scan")).exit_code, 0);
}

// Another recording of the same place goes on with a scan, or is localised in it. Both recordings'
// clocks begin at the same time.
TEST_F(Cli, ASecondSessionHasAPathOfItsOwn) {
    const std::string scan = folder / "a.scan", second = folder / "second";
    const std::string small = "--set mapping.voxel_size_m=0.02 ";
    const std::string camera =
        "--set synthetic.width=320 --set synthetic.height=240 --set synthetic.fx=262.5 "
        "--set synthetic.fy=262.5 --set synthetic.cx=159.5 --set synthetic.cy=119.5 ";
    ASSERT_EQ(Call("synth desk --frames 24 " + camera + "--out " + second).exit_code, 0);
    ASSERT_EQ(Call("run synthetic:desk --frames 40 " + camera + small + "--out " +
                   (folder / "first") + " --scan " + scan)
                  .exit_code,
              0);
    const Outcome localised =
        Call("run " + second + " --out " + (folder / "l") + " --localise-only " + scan);
    EXPECT_EQ(localised.exit_code, 0) << localised.err;
    EXPECT_NE(localised.out.find("24 frames, 24 tracked, 0 fused"), std::string::npos)
        << localised.out << localised.err;
    EXPECT_EQ(ReadTrajectory(folder / "l/trajectory.txt").value().poses.size(), 24u);
    const Outcome resumed =
        Call("run " + second + " --frames 10 --out " + (folder / "r") + " --resume " + scan);
    EXPECT_EQ(resumed.exit_code, 0) << resumed.err;
    EXPECT_NE(resumed.out.find("10 pairs"), std::string::npos) << resumed.out;
    EXPECT_EQ(ReadTrajectory(folder / "r/trajectory.txt").value().poses.size(), 10u);
    EXPECT_EQ(ReadTrajectory(folder / "r/trajectory_1.txt").value().poses.size(), 40u);
    // What is left of the second recording, not of the first.
    const Outcome rest = Call("run " + second + " --out " + (folder / "r") + " --resume " + scan);
    EXPECT_NE(rest.out.find("14 frames, 14 tracked"), std::string::npos) << rest.out << rest.err;
    EXPECT_EQ(ReadTrajectory(folder / "r/trajectory.txt").value().poses.size(), 24u);
    const Outcome other = Call("run " + second + " --out " + (folder / "o") + " --scan " +
                               (folder / "b.scan") + " " + small);
    ASSERT_EQ(other.exit_code, 0) << other.err;
    ExpectRefused("scan merge " + scan + " " + (folder / "b.scan") + " --out " + scan, scan);
    ExpectRefused("scan merge " + scan + " " + (folder / "no.scan") + " --out " + (folder / "c"),
                  "no.scan");
    ExpectRefused("run " + second + " --localise-only " + scan + " --labels synthetic",
                  "--localise-only");
    ExpectRefused("run " + second + " --localise-only " + scan + " --resume " + scan,
                  "--localise-only");
}

TEST_F(Cli, LoopClosureIsRefusedWhereItCannotBe) {
    const std::string poses = folder / "poses.txt";
    std::ofstream(poses) << "0 0 0 0 0 0 0 1\n";
    ExpectRefused("run synthetic:desk --loop-closure on --poses " + poses, "--loop-closure on");
    const std::string refine =
        "run synthetic:desk --set calibration.refine=true --out " + (folder / "refine");
    ExpectRefused(refine + " --loop-closure off", "needs --loop-closure on");
    ExpectRefused(refine + " --scan " + (folder / "c.scan"), "not possible with --scan");
}

TEST_F(Cli, SwitchNeedsAFrameAndAMethod) {
    for (const char* value : {"icp", "5", "5:", ":icp", "-1:icp", "5:kinfu", "x:icp", "5:icp:sdf"})
        ExpectRefused(SmallRun() + "--frames 3 --switch " + value, "--switch");
}

TEST_F(Cli, SwitchesTheTrackerBetweenTwoFrames) {
    const std::string out = folder / "switched";
    const Outcome run =
        Call(SmallRun() + "--frames 6 --switch 4:icp --switch 2:icp-rgb --out " + out);
    ASSERT_EQ(run.exit_code, 0) << run.err;
    std::ifstream csv(out + "/frames.csv");
    std::vector<std::string> methods;
    std::string line;
    for (std::getline(csv, line); std::getline(csv, line);) {
        const std::size_t second = line.find(',', line.find(',') + 1);
        methods.push_back(line.substr(second + 1, line.find(',', second + 1) - second - 1));
    }
    EXPECT_EQ(methods,
              (std::vector<std::string>{"sdf", "sdf", "icp-rgb", "icp-rgb", "icp", "icp"}));
}

TEST_F(Cli, InspectDrawsAFrameAgainstTheMap) {
    const std::string picture = folder / "frame.png";
    const std::string arguments = SmallRun() + "--frame 3 --out " + picture;
    const Outcome inspect = Call("inspect" + arguments.substr(arguments.find(' ')));
    ASSERT_EQ(inspect.exit_code, 0) << inspect.err;
    EXPECT_NE(inspect.out.find("frame 3 by sdf: good"), std::string::npos) << inspect.out;
    EXPECT_TRUE(std::filesystem::exists(picture));
    const Outcome labelled = Call("inspect" + arguments.substr(arguments.find(' ')) +
                                  " --labels synthetic --set labels.min_observations=2");
    ASSERT_EQ(labelled.exit_code, 0) << labelled.err;
    EXPECT_EQ(ReadColourImage(picture).value().width(), 2 * 160);  // without labels three beside
    ExpectRefused("inspect synthetic:desk --frame 3 --out " + picture + " --labels none.onnx",
                  "none.onnx");
    const Outcome beyond =
        Call("inspect synthetic:desk --frame 99999 --out " + picture + " --set synthetic.frames=2");
    EXPECT_EQ(beyond.exit_code, 2);
}

TEST_F(Cli, RunsAndEvaluates) {
    const std::string out = folder / "o";
    const Outcome run = Call(
        SmallRun() +
        "--frames 5 --device cpu --mode lockstep --labels none --loop-closure off --out " + out);
    ASSERT_EQ(run.exit_code, 0) << run.err;
    EXPECT_NE(run.out.find("ATE RMSE"), std::string::npos) << run.out;
    EXPECT_EQ(run.err.find('\r'), std::string::npos) << "a progress bar without a terminal";
    for (const char* file :
         {"trajectory.txt", "mesh.ply", "objects.json", "timings.json", "run.json", "preview.png"})
        EXPECT_TRUE(std::filesystem::exists(out + "/" + file)) << file;

    const std::string trajectory = out + "/trajectory.txt", mesh = out + "/mesh.ply";
    const Outcome ate = Call("eval ate " + trajectory + " " + trajectory + " --json " +
                             (folder / "ate.json") + " --plot " + (folder / "ate.png"));
    ASSERT_EQ(ate.exit_code, 0) << ate.err;
    EXPECT_NE(ate.out.find("ATE RMSE 0.0000 m"), std::string::npos) << ate.out;
    EXPECT_NE(ReadAll(folder / "ate.json").find("\"alignment\""), std::string::npos);
    EXPECT_TRUE(std::filesystem::exists(folder / "ate.png"));
    const Outcome surface =
        Call("eval mesh " + mesh + " " + mesh + " --align " + trajectory + " " + trajectory +
             " --json " + (folder / "mesh.json") + " --picture " + (folder / "mesh.png"));
    ASSERT_EQ(surface.exit_code, 0) << surface.err;
    EXPECT_NE(ReadAll(folder / "mesh.json").find("\"completeness_5cm\""), std::string::npos);
    EXPECT_EQ(Call("render " + mesh + " --out " + (folder / "m.png") + " --width 64 --height 48")
                  .exit_code,
              0);
    // Five frames span less than one second.
    ExpectRefused("eval rpe " + trajectory + " " + trajectory, trajectory);
    EXPECT_EQ(Call("eval rpe " + trajectory + " " + trajectory + " --delta 0.1").exit_code, 0);
}

TEST_F(Cli, TheSummarySaysThatTheSceneLeftAMotionOpen) {
    const std::string note = "frames are degenerate: the scene leaves a motion open";
    EXPECT_EQ(Succeeds(SmallRun() + "--frames 5 --out " + (folder / "desk")).find(note),
              std::string::npos);
    const std::string out = Succeeds(
        SmallRun("floor") + "--frames 5 --tracker sdf-geometric --out " + (folder / "floor"));
    EXPECT_NE(out.find("note: 4 of the tracked " + note), std::string::npos) << out;
}

TEST_F(Cli, MostlyLostIsExitCode3) {
    const Outcome run = Call(
        SmallRun() + "--frames 4 --set frame.min_depth_m=50 --set frame.max_depth_m=60 --out " +
        (folder / "o"));
    EXPECT_EQ(run.exit_code, 3);
    EXPECT_NE(run.err.find("depth_scale"), std::string::npos) << run.err;
}

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

TEST_F(Cli, ConfigRoundTrips) {
    const Outcome yaml = Call("config --config bylow2014 --set tracking.sdf.levels=2");
    ASSERT_EQ(yaml.exit_code, 0) << yaml.err;
    std::ofstream(folder / "my.yaml") << yaml.out;
    EXPECT_EQ(Call("config --config " + (folder / "my.yaml")).out, yaml.out);
    EXPECT_NE(yaml.out.find("levels: 2"), std::string::npos);
}

TEST_F(Cli, InfoAndDoctorSayWhatThereIs) {
    const Outcome info = Call("info synthetic:desk");
    EXPECT_EQ(info.exit_code, 0) << info.err;
    EXPECT_NE(info.out.find("640 x 480"), std::string::npos) << info.out;
    EXPECT_NE(info.out.find("depth in"), std::string::npos) << info.out;
    EXPECT_NE(info.out.find("tessera run synthetic:desk --out DIR"), std::string::npos);
    std::ofstream(folder / "a.ply") << "ply";
    const Outcome mesh = Call("info " + (folder / "a.ply"));
    EXPECT_EQ(mesh.exit_code, 0) << mesh.err;
    EXPECT_NE(mesh.out.find("a mesh; tessera view"), std::string::npos) << mesh.out;
    EXPECT_NE(Call("help run").out.find("--loop-closure"), std::string::npos);
    ExpectRefused("help rnu", "did you mean run?");
    const Outcome doctor = Call("doctor");
    EXPECT_EQ(doctor.exit_code, 0);
    EXPECT_NE(doctor.out.find("CUDA"), std::string::npos);
}

}  // namespace
}  // namespace tessera
