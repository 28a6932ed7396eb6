// Whole runs from the command line, and what can be done with their results.
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "apps/cli_fixture.h"
#include "io/image_io.h"

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
    EXPECT_NE(ate.out.find("100.0 % of the frames tracked"), std::string::npos) << ate.out;
    const std::string elsewhere = folder / "alone.txt";
    std::filesystem::copy_file(trajectory, elsewhere);
    EXPECT_NE(Call("eval ate " + trajectory + " " + elsewhere)
                  .out.find("100.0 % of the poses have a reference"),
              std::string::npos);
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

TEST_F(Cli, EvalMeshSaysWhatItsFiguresCannotMean) {
    const std::string
        vertices =
            "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
            "property float z\n",
        places = "0 0 0\n1 0 0\n0 1 0\n", line = folder / "line.txt";
    std::ofstream(folder / "cloud.ply") << vertices << "end_header\n" << places;
    std::ofstream(folder / "mesh.ply")
        << vertices << "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
        << places << "3 0 1 2\n";
    std::ofstream path(line);
    for (int i = 0; i < 5; ++i) path << i << ' ' << i << " 0 0 0 0 0 1\n";
    path.close();
    const std::string mesh = "eval mesh " + (folder / "mesh.ply") + " ";
    const Outcome aligned = Call(mesh + (folder / "mesh.ply") + " --align " + line + " " + line);
    EXPECT_EQ(aligned.exit_code, 0);
    EXPECT_NE(aligned.err.find("note: the camera moved along a line"), std::string::npos)
        << aligned.err;
    EXPECT_NE(Succeeds(mesh + (folder / "cloud.ply")).find("3 vertices"), std::string::npos);
    ExpectRefused(mesh + (folder / "cloud.ply") + " --picture " + (folder / "e.png"),
                  "has no triangles to draw");
    EXPECT_FALSE(std::filesystem::exists(folder / "e.png"));
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

}  // namespace
}  // namespace tessera
