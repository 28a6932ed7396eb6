// Tests the contract of docs/design.md, section 8: options, exit codes, one line on stderr.
#include <filesystem>
#include <fstream>
#include <string>

#include "apps/cli_fixture.h"

namespace tessera {
namespace {

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
    const Outcome alone = Call("");
    EXPECT_EQ(alone.exit_code, 2);
    EXPECT_EQ(alone.err, Call("help").out);
    ExpectRefused("eval", "subcommand");
    ExpectRefused("calibrate /no/such/folder", "/no/such/folder");
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
    for (const char* command : {"plan ", "finish "}) {
        ExpectRefused(command + folder.path() + " --out " + (folder / "new"),
                      "has no mesh.ply; give the folder that tessera run --out wrote");
        ExpectRefused(command + std::string("/no/such/run --out ") + (folder / "new"),
                      "/no/such/run");
        EXPECT_FALSE(std::filesystem::exists(folder / "new")) << command;
    }
    for (const char* name : {"model.obj", "model.glb"}) {
        std::ofstream(folder / name) << "x";
        ExpectRefused("view " + (folder / name), "open it in Blender or f3d");
        ExpectRefused("view " + folder.path(),
                      std::string("holds a finished model: open ") + name + " in Blender or f3d");
    }
    ExpectRefused("sweep alpha synthetic:desk --values 1:0:1", "--values");
    ExpectRefused("sweep alpha synthetic:desk --values 0:1:0", "--values");
    ExpectRefused("info /no/such/folder", "/no/such/folder");
}

TEST_F(Cli, AGpuThatIsAskedForByNameAndIsNotThereIsRefused) {
    if (Call("doctor").out.find("compute capability") != std::string::npos)
        GTEST_SKIP() << "this machine has a GPU";
    ExpectRefused("run synthetic:desk --device cuda", "--device cuda");
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
    EXPECT_NE(Call("info synthetic:desk --set synthetic.frames=1").out.find("frames: 1 pair of"),
              std::string::npos);
    const std::string room = "'" + (folder / "a room") + "'";
    ASSERT_EQ(Call("synth desk --frames 1 --out " + room).exit_code, 0);
    EXPECT_NE(Call("info " + room).out.find("tessera run " + room + " --out DIR"),
              std::string::npos);
    std::ofstream(folder / "a.ply") << "ply";
    std::ofstream(folder / "2. OG (neu).ply") << "ply";
    const std::string spaced = "'" + (folder / "2. OG (neu).ply") + "'";
    EXPECT_NE(Call("info " + spaced).out.find("tessera view " + spaced), std::string::npos);
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
