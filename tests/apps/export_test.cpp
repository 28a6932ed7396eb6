// Tests the command `tessera export`. The tests of each writer check the content of its format.
#include <Eigen/Geometry>

#include "apps/cli_fixture.h"
#include "io/mesh_io.h"

namespace tessera {
namespace {

class Export : public Cli {
  protected:
    // Writes a run and a scan of four frames. `keep` can ask for raw frames.
    void Scan(const std::string& keep) const {
        const Outcome run = Call(SmallRun() + keep + " --frames 4 --out " + (folder / "run") +
                                 " --scan " + (folder / "a.scan"));
        ASSERT_EQ(run.exit_code, 0) << run.err;
    }
};

TEST_F(Export, WritesEveryFormatOutOfAScan) {
    ASSERT_NO_FATAL_FAILURE(Scan("--set scan.frames=all"));
    const Outcome all =
        Call("export " + (folder / "a.scan") + " --mesh " + (folder / "m.glb") + " --cloud " +
             (folder / "c.ply") + " --kitti " + (folder / "k.txt") + " --frames " +
             (folder / "ns/transforms.json") + " --colmap " + (folder / "cm"));
    ASSERT_EQ(all.exit_code, 0) << all.err;
    EXPECT_EQ(ReadAll(folder / "m.glb").substr(0, 4), "glTF");
    EXPECT_EQ(ReadPly(folder / "c.ply").value().vertices,
              ReadPly(folder / "run/mesh.ply").value().vertices);
    const std::string kitti = ReadAll(folder / "k.txt");
    EXPECT_EQ(std::count(kitti.begin(), kitti.end(), '\n'), 4);
    for (const char* name : {"k.txt.times", "ns/transforms.json", "ns/images/000003.jpg",
                             "ns/depth/000003.png", "ns/points.ply", "cm/cameras.txt",
                             "cm/images.txt", "cm/points3D.txt", "cm/images/000000.jpg"})
        EXPECT_GT(std::filesystem::file_size(folder / name), 0u) << name;
    ASSERT_EQ(Call("export " + (folder / "a.scan") + " --frames " + (folder / "raw")).exit_code, 0);
    EXPECT_TRUE(std::filesystem::exists(folder / "raw/camera.yaml"));
    ExpectRefused("export " + (folder / "a.scan") + " --colmap " + (folder / "cm"),
                  "already contains files");
}

TEST_F(Export, MapsOfARunsFolderNeedAScan) {
    ASSERT_NO_FATAL_FAILURE(Scan(""));
    ExpectRefused("maps " + (folder / "run") + " --ros-map " + (folder / "m.yaml"),
                  "maps need a scan: run with --scan FILE and give that file");
}

TEST_F(Export, CropsToABox) {
    ASSERT_NO_FATAL_FAILURE(Scan(""));
    const std::string command =
        "export " + (folder / "run") + " --mesh " + (folder / "m.ply") + " --box ";
    const auto whole = ReadPly(folder / "run/mesh.ply");
    ASSERT_TRUE(whole.ok());
    Eigen::AlignedBox3f all;
    for (const Eigen::Vector3f& v : whole.value().vertices) all.extend(v);
    const float middle = all.center().x();
    const Outcome half = Call(command + fmt::format("{} -9 -9 9 9 9", middle));
    ASSERT_EQ(half.exit_code, 0) << half.err;
    const auto cropped = ReadPly(folder / "m.ply");
    ASSERT_TRUE(cropped.ok());
    EXPECT_LT(cropped.value().triangles.size(), whole.value().triangles.size());
    Eigen::AlignedBox3f left;
    for (const Eigen::Vector3f& v : cropped.value().vertices) left.extend(v);
    EXPECT_GE(left.min().x(), middle - 1e-5f);
    ExpectRefused(command + "1 0 0 0 1 1", "--box: give the lowest");
    ExpectRefused(command + "90 90 90 91 91 91", "nothing of the mesh is in the box");
    ExpectRefused(
        "export " + (folder / "run") + " --trajectory " + (folder / "t.txt") + " --box 0 0 0 1 1 1",
        "give --mesh or --cloud");
    ExpectRefused(
        "finish " + (folder / "run") + " --out " + (folder / "f") + " --box 90 90 90 91 91 91",
        "nothing of the mesh is in the box");
}

TEST_F(Export, ABoxLeavesThePointsForOtherProgramsWhole) {
    ASSERT_NO_FATAL_FAILURE(Scan("--set scan.frames=all"));
    const std::string from = "export " + (folder / "a.scan");
    const auto whole = ReadPly(folder / "run/mesh.ply");
    ASSERT_TRUE(whole.ok());
    Eigen::AlignedBox3f all;
    for (const Eigen::Vector3f& v : whole.value().vertices) all.extend(v);
    Succeeds(from + " --colmap " + (folder / "all"));
    Succeeds(from + " --colmap " + (folder / "cm") + " --frames " + (folder / "ns/t.json") +
             " --mesh " + (folder / "m.ply") +
             fmt::format(" --box {} -9 -9 9 9 9", all.center().x()));
    EXPECT_LT(ReadPly(folder / "m.ply").value().triangles.size(), whole.value().triangles.size());
    EXPECT_EQ(ReadAll(folder / "cm/points3D.txt"), ReadAll(folder / "all/points3D.txt"));
    EXPECT_EQ(ReadPly(folder / "ns/points.ply").value().vertices.size(),
              whole.value().vertices.size());
}

TEST_F(Export, AFinishedModelLeavesNoFilesOfAnother) {
    ASSERT_NO_FATAL_FAILURE(Scan(""));
    const std::string finish = "finish " + (folder / "run") + " --out " + (folder / "f");
    std::filesystem::create_directory(folder / "f");
    for (const char* name : {"model_lod1.glb", "model_lod3.glb", "watertight.obj", "mine.txt"})
        std::ofstream(folder / "f/" + name) << "old";
    const Outcome first = Call(finish + " --watertight 0.01");
    ASSERT_EQ(first.exit_code, 0) << first.err;
    EXPECT_FALSE(std::filesystem::exists(folder / "f/model_lod1.glb"));
    EXPECT_FALSE(std::filesystem::exists(folder / "f/model_lod3.glb"));
    EXPECT_GT(std::filesystem::file_size(folder / "f/watertight.obj"), 100u);
    const Outcome second = Call(finish);
    ASSERT_EQ(second.exit_code, 0) << second.err;
    EXPECT_FALSE(std::filesystem::exists(folder / "f/watertight.obj"));
    EXPECT_EQ(ReadAll(folder / "f/mine.txt"), "old");
}

TEST_F(Export, AVolumeIsWrittenOrSaysWhatToInstall) {
    ASSERT_NO_FATAL_FAILURE(Scan(""));
    const std::string command = "export " + (folder / "a.scan") + " --grid " + (folder / "g.vdb");
    if (Call("doctor").out.find(".vdb not in this build") != std::string::npos) {
        ExpectRefused(command, "libopenvdb-dev");
        return;
    }
    const Outcome grid = Call(command);
    EXPECT_EQ(grid.exit_code, 0) << grid.err;
    EXPECT_GT(std::filesystem::file_size(folder / "g.vdb"), 1000u);
}

TEST_F(Export, OfARunItWritesMeshCloudAndPathAndNamesWhatItLacks) {
    ASSERT_NO_FATAL_FAILURE(Scan(" --loop-closure off "));
    const std::string from = "export " + (folder / "run");
    EXPECT_EQ(Call(from + " --mesh " + (folder / "m.obj") + " --cloud " + (folder / "c.ply") +
                   " --trajectory " + (folder / "t.txt"))
                  .exit_code,
              0);
    EXPECT_EQ(ReadAll(folder / "t.txt").substr(0, 1), "#");
    for (const char* option :
         {" --grid g.vdb", " --frames new", " --frames t.json", " --colmap new"})
        ExpectRefused(from + option, "FILE.scan");
    for (const char* option : {" --frames ", " --colmap "}) {
        const std::string json = option == std::string(" --frames ") ? "t.json" : "cm";
        ExpectRefused("export " + (folder / "a.scan") + " --mesh " + (folder / "m.glb") + option +
                          (folder / json),
                      "scan.frames=all");
    }
    EXPECT_FALSE(std::filesystem::exists(folder / "m.glb"));
}

TEST_F(Export, RefusesWhatItCannotWrite) {
    ExpectRefused("export out", "nothing to export");
    ExpectRefused("export out --mesh a.stl",
                  "--mesh a.stl: a mesh can be written as .ply, .obj, .glb");
    ExpectRefused("export /no/such.scan --mesh a.glb", "/no/such.scan");
    ExpectRefused("export a.scan --cloud a.obj", "--cloud a.obj");
    ExpectRefused("export a.scan --grid a.nvdb", "--grid a.nvdb");
}

}  // namespace
}  // namespace tessera
