// Whole runs on a small file system of their own (a mount namespace) that is full sooner or later.
// Nothing is left half written, and the run goes on.
#include "apps/cli_fixture.h"
#include "io/mesh_io.h"
#include "io/trajectory.h"
#include "support/temp_folder.h"

namespace tessera {
namespace {

class FullDisk : public Cli {
  protected:
    void SetUp() override {
        if (std::system("unshare -rm sh -c 'mount -t tmpfs none /mnt' 2>/dev/null") != 0)
            GTEST_SKIP() << "no mount namespaces here: run as root, or allow them for users";
    }

    // Runs the commands with a file system of `kilobytes` at /mnt. Its content is then in `folder`.
    void Within(int kilobytes, const std::string& commands) const {
        std::ofstream(folder / "commands")
            << "mount -t tmpfs -o size=" << kilobytes << "k none /mnt\n"
            << "program=" TESSERA_PROGRAM "\nout=" << folder.path() << "\n"
            << commands << "\ncp -r /mnt $out/disk\n";
        const std::string command = "rm -rf " + (folder / "disk") + "; unshare -rm sh " +
                                    (folder / "commands") + " 2>" + (folder / "shell");
        EXPECT_EQ(std::system(command.c_str()), 0) << ReadAll(folder / "shell");
    }
    int Code() const { return std::atoi(ReadAll(folder / "code").c_str()); }
};

TEST_F(FullDisk, NothingIsHalfWrittenAndTheRunGoesOn) {
    int without_room = 0, whole = 0;
    for (const int kilobytes : {60, 300, 500, 800, 1800, 2600, 16000}) {
        SCOPED_TRACE(kilobytes);
        Within(kilobytes, "$program " + SmallRun() +
                              "--frames 60 --out /mnt/o --scan /mnt/a.scan --record /mnt/rec "
                              ">$out/stdout 2>$out/stderr\necho $? >$out/code\n"
                              "[ ! -e /mnt/a.scan ] || $program info /mnt/a.scan >/dev/null 2>&1\n"
                              "echo $? >$out/scan_code");
        const std::string said = ReadAll(folder / "stderr");
        EXPECT_EQ(ReadAll(folder / "scan_code"), "0\n");
        for (const auto& entry : std::filesystem::recursive_directory_iterator(folder / "disk"))
            EXPECT_EQ(entry.path().string().find(".tmp"), std::string::npos) << entry.path();
        if (const std::string mesh = folder / "disk/o/mesh.ply"; std::filesystem::exists(mesh)) {
            const auto read = ReadPly(mesh);
            EXPECT_TRUE(read.ok()) << read.message();
        }
        if (std::filesystem::exists(folder / "disk/rec/camera.yaml")) {
            const Outcome info = Call("info " + (folder / "disk/rec"));
            EXPECT_TRUE(info.exit_code == 0 ||
                        info.err.find("no line of the form") != std::string::npos)
                << info.err;
        }
        if (Code() == 0) {
            ++whole;
            EXPECT_EQ(ReadTrajectory(folder / "disk/o/trajectory.txt").value().poses.size(), 60u);
            continue;
        }
        ++without_room;
        EXPECT_EQ(Code(), 2) << said;
        EXPECT_NE(said.find("no space left on the device; free some space"), std::string::npos)
            << said;
        EXPECT_EQ(said.find("libpng"), std::string::npos) << said;
    }
    EXPECT_GE(without_room, 5);
    EXPECT_GE(whole, 1);
}

TEST_F(FullDisk, LinesThatFoundNoRoomAreWrittenOnceThereIsSome) {
    Within(6000, "$program " + SmallRun() +
                     "--frames 400 --set synthetic.speed=0.2 --loop-closure off --out /mnt/o "
                     ">$out/stdout 2>$out/stderr &\n"
                     "while kill -0 $! && ! [ -s /mnt/o/frames.csv ]; do :; done\n"
                     "cat /dev/zero >/mnt/filler\n"
                     "while kill -0 $! && ! grep -q 'tries again' $out/stderr; do :; done\n"
                     "rm /mnt/filler\nwait $!\necho $? >$out/code");
    const std::string said = ReadAll(folder / "stderr");
    EXPECT_EQ(Code(), 0) << said;
    EXPECT_NE(said.find("frames.csv: cannot be written: no space left"), std::string::npos) << said;
    EXPECT_NE(said.find("the run goes on and tries again"), std::string::npos) << said;
    const std::string frames = ReadAll(folder / "disk/o/frames.csv");
    EXPECT_EQ(std::count(frames.begin(), frames.end(), '\n'), 401);
    EXPECT_EQ(ReadTrajectory(folder / "disk/o/trajectory.txt").value().poses.size(), 400u);
}

}  // namespace
}  // namespace tessera
