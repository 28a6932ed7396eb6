#include "run/open_source.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "recordings/open_recording.h"
#include "support/temp_folder.h"

namespace tessera {
namespace {

TEST(OpenSource, ASceneByItsName) {
    const auto source = OpenSource("synthetic:desk", RunConfig());
    ASSERT_TRUE(source.ok()) << source.message();
    EXPECT_TRUE(source.value()->info().has_truth);
    EXPECT_GT(source.value()->info().frame_count, 100);
}

TEST(OpenSource, WhatIsWrongIsNamed) {
    const TempFolder folder;
    std::ofstream(folder / "file.txt") << "x";
    const auto message = [](const std::string& name) {
        return OpenSource(name, RunConfig()).message();
    };
    EXPECT_EQ(message("/no/such"),
              "/no/such: no such folder (a source is a folder, FILE.oni, .klg, .bag, .mcap, .db3, "
              ".mkv, .r3d, .sens or .scan, openni2:, pipe:- or synthetic:NAME)");
    EXPECT_NE(message("gopher:x").find("gopher: is not a kind of source (a source is"),
              std::string::npos);
    EXPECT_NE(message("realsense:").find("send their frames to pipe:-"), std::string::npos);
    EXPECT_NE(message(folder / "file.txt").find("is a file"), std::string::npos);
    EXPECT_NE(message("synthetic:dsk").find("desk"), std::string::npos) << message("synthetic:dsk");
    EXPECT_NE(message(folder.path()).find(folder.path()), std::string::npos);  // an empty folder
    EXPECT_EQ(message("a.klg"), "a.klg: no such file");
    EXPECT_NE(message("a.scan").find("a.scan"), std::string::npos) << message("a.scan");
}

TEST(OpenSource, OtherFilesAreSaidToBeWhatTheyAre) {
    const TempFolder folder;
    const auto expect = [&](const std::string& name, const std::string& text,
                            const std::string& words) {
        std::ofstream(folder / name) << text;
        const std::string message = OpenSource(folder / name, RunConfig()).message();
        EXPECT_EQ(message.find((folder / name) + ": is no source of frames: "), 0u) << message;
        EXPECT_NE(message.find(words), std::string::npos) << message;
    };
    expect("a.ply", "", "tessera view " + (folder / "a.ply") + " shows it");
    expect("b.zip", "", "unpack it and give the folder");
    expect("rgb.mp4", "", "give the folder that holds it (Stray Scanner: rgb.mp4)");
    expect("{} c.ply", "", "tessera view '" + (folder / "{} c.ply") + "' shows it");
    expect("c.onnx", "", "tessera run SOURCE --labels " + (folder / "c.onnx"));
    expect("d.txt", "1 0 0 0 0 0 0 1\n2 0 0 0 0 0 0 1\n", "a path of 2 poses");
    expect("camera.yaml", "width: 32\nheight: 24\nfx: 30\nfy: 30\ncx: 16\ncy: 12\n",
           "a camera file");
    expect("e.yaml", "mapping:\n  voxel_size_m: 0.02\n", "--config " + (folder / "e.yaml"));
    std::ofstream(folder / "run.json") << "{}";
    EXPECT_NE(OpenSource(folder.path(), RunConfig()).message().find("the results of a run"),
              std::string::npos);
}

TEST(OpenSource, AFolderThatIsNearlyASourceIsSaidToBeWhatItIs) {
    const TempFolder folder;
    const auto make = [&](const std::string& name) {
        std::filesystem::create_directories(folder / name);
    };
    const auto expect = [&](const std::string& name, const std::string& words) {
        EXPECT_EQ(OpenSource(folder / name, RunConfig()).message(), (folder / name) + ": " + words);
    };
    make("stray/room");
    std::ofstream(folder / "stray/room/rgb.mp4") << "x";
    expect("stray/room",
           "looks like a Stray Scanner recording; depth/ and camera_matrix.csv are missing; copy "
           "the whole folder again");
    make("stray/room/depth");
    expect("stray/room",
           "looks like a Stray Scanner recording; camera_matrix.csv is missing; copy the whole "
           "folder again");
    make("poly/keyframes/depth");
    expect("poly",
           "looks like a Polycam recording; keyframes/cameras/ is missing; copy the whole folder "
           "again");
    make("poly/keyframes/corrected_cameras");
    make("poly/keyframes/images");
    expect("poly/keyframes", "is the inner folder of a Polycam recording; give the folder above");
    make("record3d/rgbd");
    std::ofstream(folder / "record3d/metadata") << "{}";
    expect("record3d", "is an unpacked Record3D recording; give the .r3d file itself");
    make("parent");
    std::ofstream(folder / "parent/a.r3d") << "x";
    expect("parent", "contains a.r3d, a Record3D recording; give it instead");
    std::ofstream(folder / "parent/b.mkv") << "x";
    expect("parent", "contains a.r3d, a Record3D recording, and 1 more; give one of them");
    make("model");
    std::ofstream(folder / "model/model.glb") << "x";
    expect("model", "holds a finished model, and is no source of frames");
    if (!RecordingsAvailable()) GTEST_SKIP() << kRecordingsUnavailable;
    std::ofstream(folder / "stray/room/camera_matrix.csv") << "x";
    expect("stray", "contains room, a Stray Scanner recording; give it instead");
}

TEST(OpenSource, RecordingsOfOtherProgramsAreOpened) {
    const TempFolder folder;
    for (const char* name : {"a.BAG", "b.mcap", "c.db3", "d.mkv", "e.r3d", "f.sens"}) {
        std::ofstream(folder / name) << "no recording";
        const std::string message = OpenSource(folder / name, RunConfig()).message();
        EXPECT_EQ(message.find((folder / name) + ": "), 0u) << message;
        EXPECT_EQ(message.find("a source is"), std::string::npos) << message;
    }
    if (!RecordingsAvailable()) GTEST_SKIP() << kRecordingsUnavailable;
    EXPECT_EQ(OpenSource(folder / "b.mcap", RunConfig()).message(),
              (folder / "b.mcap") + ": is not an .mcap file");
}

TEST(OpenSource, CamerasAreLive) {
    for (const char* name : {"openni2:", "openni2:test://0", "pipe:-", "pipe:/tmp/a.sock"})
        EXPECT_TRUE(IsLiveSource(name)) << name;
    for (const char* name : {"a.oni", "folder", "synthetic:desk", "a.scan"})
        EXPECT_FALSE(IsLiveSource(name)) << name;
}

}  // namespace
}  // namespace tessera
