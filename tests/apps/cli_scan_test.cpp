// Scans from the command line: saved, looked at, resumed, handed out, repaired and merged.
#include <filesystem>
#include <string>

#include "apps/cli_fixture.h"
#include "io/trajectory.h"

namespace tessera {
namespace {

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
    // A run that was killed after its last frame: no frame is left, but the results are missing.
    const Outcome complete =
        Call(SmallRun() + "--frames 20 --out " + (folder / "third") + " --resume " + scan);
    EXPECT_EQ(complete.exit_code, 0) << complete.err;
    EXPECT_NE(complete.err.find("has all of these frames"), std::string::npos) << complete.err;
    EXPECT_EQ(ReadAll(folder / "third/trajectory.txt"), ReadAll(folder / "second/trajectory.txt"));
    EXPECT_EQ(ReadAll(folder / "third/mesh.ply"), ReadAll(folder / "second/mesh.ply"));
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

}  // namespace
}  // namespace tessera
