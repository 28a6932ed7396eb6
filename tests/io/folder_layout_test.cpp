#include "io/folder_layout.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "io/temporary_folder.h"
#include "io/tum_lists.h"

namespace tessera {
namespace {

const std::string kTenHertzCamera = std::string(kSmallCamera) + "fps: 10\n";

Result<FolderLayout> Read(const TemporaryFolder& folder) {
    return ReadFolderLayout(folder.path(), 0.02);
}

bool HasNote(const FolderLayout& layout, const std::string& part) {
    for (const std::string& note : layout.notes)
        if (note.find(part) != std::string::npos) return true;
    return false;
}

TEST(FolderLayout, TakesTheCameraOfOpen3dFolders) {
    TemporaryFolder folder;
    folder.WriteText("depth/00001.png", "");
    folder.WriteText("color/00001.jpg", "");
    const auto write = [&](const std::string& matrix) {
        folder.WriteText("intrinsic.json",
                         R"({"width": 640, "height": 480, "intrinsic_matrix": )" + matrix + "}");
    };
    write("[525.5, 0, 0, 0, 526.5, 0, 319.25, 239.75, 1]");
    const auto layout = Read(folder);
    ASSERT_TRUE(layout.ok()) << layout.message();
    EXPECT_TRUE(layout.value().camera_known);
    EXPECT_EQ(layout.value().calibration.pinhole,
              (PinholeCamera{640, 480, 525.5, 526.5, 319.25, 239.75}));
    EXPECT_EQ(layout.value().calibration.depth_scale, 1000);
    EXPECT_TRUE(HasNote(layout.value(), "camera from intrinsic.json, depth in millimetres"));

    const std::string path = folder.Path("intrinsic.json");
    write("[525.5, 0, 0]");
    EXPECT_EQ(Read(folder).message().find(path + ": fy: "), 0u) << Read(folder).message();
    for (const char* text : {"", "[]", "{", R"({"width": "640"})"}) {
        folder.WriteText("intrinsic.json", text);
        EXPECT_EQ(Read(folder).message(),
                  path + ": has no width, height and intrinsic_matrix of 9 numbers");
    }
    folder.WriteText("camera.yaml", kSmallCamera);  // comes first
    EXPECT_EQ(Read(folder).value().calibration.pinhole.width, 32);
}

TEST(ReadFolderLayout, RecognisesTumListsAndTheirCameraFile) {
    TemporaryFolder folder("rgbd_dataset_freiburg1_rpy");  // camera.yaml overrides the name
    WriteTumLists(folder);
    folder.WriteText("camera.yaml", kTenHertzCamera);
    const auto layout = Read(folder);
    ASSERT_TRUE(layout.ok()) << layout.message();
    EXPECT_EQ(layout.value().kind, "TUM RGB-D folder");
    EXPECT_EQ(layout.value().calibration.pinhole.fx, 30);
    EXPECT_EQ(layout.value().camera_from, "camera.yaml");
    ASSERT_EQ(layout.value().frames.size(), 2u);
    EXPECT_EQ(layout.value().frames[1].depth_path, folder.Path("depth/2.png"));
    EXPECT_TRUE(layout.value().notes.empty());
}

TEST(ReadFolderLayout, TakesThePublishedCameraOfANamedFolder) {
    TemporaryFolder folder("rgbd_dataset_freiburg2_desk");
    WriteTumLists(folder);
    for (const std::string& path : {folder.path(), folder.path() + "/"}) {
        const auto layout = ReadFolderLayout(path, 0.02);
        ASSERT_TRUE(layout.ok()) << layout.message();
        EXPECT_EQ(layout.value().calibration.pinhole.fx, 520.9);
        EXPECT_EQ(layout.value().calibration.distortion.k3, 0.9172);
        EXPECT_TRUE(HasNote(layout.value(), "published calibration of freiburg2"));
        EXPECT_EQ(layout.value().camera_from, "the published calibration of freiburg2");
    }
}

TEST(ReadFolderLayout, ACameraThatNobodyGaveIsUnknown) {
    TemporaryFolder folder;
    WriteTumLists(folder);
    const auto layout = Read(folder);
    ASSERT_TRUE(layout.ok()) << layout.message();
    EXPECT_FALSE(layout.value().camera_known);
    folder.WriteText("camera.yaml", kTenHertzCamera);
    EXPECT_TRUE(Read(folder).value().camera_known);
}

TEST(ReadFolderLayout, RecognisesATumRecordingUnderAnyNameByItsList) {
    TemporaryFolder folder("desk");
    WriteTumLists(folder);
    folder.WriteText("rgb.txt",
                     "# color images\n# file: 'rgbd_dataset_freiburg3_teddy.bag'\n# timestamp "
                     "filename\n1.0 rgb/1.png\n2.0 rgb/2.png\n");
    const auto layout = Read(folder);
    ASSERT_TRUE(layout.ok()) << layout.message();
    EXPECT_TRUE(layout.value().camera_known);
    EXPECT_EQ(layout.value().calibration.pinhole.fx, 535.4);
    EXPECT_TRUE(HasNote(layout.value(), "published calibration of freiburg3"));
}

TEST(ReadFolderLayout, RecognisesIclNuim) {
    TemporaryFolder folder;
    folder.WriteText("associations.txt", "0 depth/0.png 0 rgb/0.png\n1 depth/1.png 1 rgb/1.png\n");
    for (const char* name : {"depth/0.png", "depth/1.png", "rgb/0.png", "rgb/1.png"})
        folder.WriteText(name, "");
    const auto layout = Read(folder);
    ASSERT_TRUE(layout.ok()) << layout.message();
    EXPECT_EQ(layout.value().kind, "ICL-NUIM folder");
    EXPECT_EQ(layout.value().calibration.pinhole,
              (PinholeCamera{640, 480, 481.2, 480.0, 319.5, 239.5}));
    EXPECT_EQ(layout.value().frames[1].depth_stamp_s, 1.0);
}

TEST(ReadFolderLayout, TheNameOfALivingRoomIsNotEnoughForIclNuim) {
    for (const char* name : {"living_room_2024", "livingRoom", "office_room", "my_frei_png"}) {
        TemporaryFolder folder(name);
        WriteTumLists(folder);
        folder.WriteText("depth.txt", "1.5 depth/1.png\n2.5 depth/2.png\n");
        folder.WriteText("rgb.txt", "1.5 rgb/1.png\n2.5 rgb/2.png\n");
        EXPECT_EQ(Read(folder).value().kind, "TUM RGB-D folder") << name;
        EXPECT_FALSE(Read(folder).value().camera_known) << name;
        folder.WriteText("livingRoom0.gt.freiburg", "1 0 0 0 0 0 0 1\n");
        EXPECT_EQ(Read(folder).value().kind, "ICL-NUIM folder") << name;
        std::filesystem::remove(folder.Path("livingRoom0.gt.freiburg"));
        WriteTumLists(folder);  // stamps 1.0 and 2.0: frame numbers
        EXPECT_EQ(Read(folder).value().kind, "ICL-NUIM folder") << name;
        EXPECT_EQ(Read(folder).value().calibration.pinhole.fx, 481.2) << name;
    }
}

TEST(ReadFolderLayout, AssociationsWithTimesAreOfAnUnknownCamera) {
    TemporaryFolder folder;
    folder.WriteText("associations.txt", "0.25 depth/0.png 0.25 rgb/0.png\n");
    folder.WriteText("depth/0.png", "");
    folder.WriteText("rgb/0.png", "");
    ASSERT_TRUE(Read(folder).ok()) << Read(folder).message();
    EXPECT_FALSE(Read(folder).value().camera_known);
    folder.WriteText("camera.yaml", kTenHertzCamera);
    ASSERT_TRUE(Read(folder).ok()) << Read(folder).message();
    EXPECT_EQ(Read(folder).value().kind, "TUM RGB-D folder");
}

TEST(ReadFolderLayout, RecognisesSevenScenes) {
    TemporaryFolder folder("seq-01");
    folder.WriteText("frame-000000.color.png", "");
    folder.WriteText("frame-000000.depth.png", "");
    const auto layout = Read(folder);
    ASSERT_TRUE(layout.ok()) << layout.message();
    EXPECT_EQ(layout.value().kind, "7-Scenes sequence");
    EXPECT_EQ(layout.value().calibration.depth_scale, 1000);
    EXPECT_EQ(layout.value().calibration.pinhole.fx, 585);
    EXPECT_EQ(layout.value().invalid_depth, 65535);
    ASSERT_TRUE(layout.value().calibration.colour);
    EXPECT_EQ(layout.value().calibration.colour->pinhole.fx, 525);
    EXPECT_FALSE(layout.value().registration_known);
    EXPECT_TRUE(HasNote(layout.value(), "another Kinect"));
    folder.WriteText("camera.yaml", std::string(kTenHertzCamera));
    EXPECT_TRUE(Read(folder).value().registration_known);
    EXPECT_FALSE(Read(folder).value().calibration.colour);
}

TEST(ReadFolderLayout, PairsAnyFolderWithACameraByName) {
    TemporaryFolder folder;
    for (const char* name : {"depth/5.png", "depth/6.png", "colour/5.jpg", "colour/6.jpg"})
        folder.WriteText(name, "");
    ASSERT_TRUE(Read(folder).ok()) << Read(folder).message();
    EXPECT_FALSE(Read(folder).value().camera_known);
    folder.WriteText("camera.yaml", kTenHertzCamera);
    const auto layout = Read(folder);
    ASSERT_TRUE(layout.ok()) << layout.message();
    EXPECT_EQ(layout.value().kind, "image folder");
    EXPECT_EQ(layout.value().frames[1].depth_stamp_s, 0.6);  // camera.yaml says 10 Hz
}

TEST(ReadFolderLayout, SaysWhatIsWrongWithTheFolder) {
    TemporaryFolder folder;
    EXPECT_EQ(ReadFolderLayout(folder.Path("absent"), 0.02).message(),
              folder.Path("absent") + ": no such folder");
    EXPECT_EQ(Read(folder).message(), folder.path() + ": is empty");
    folder.WriteText("rgb.txt", "1.0 a\n");
    EXPECT_EQ(ReadFolderLayout(folder.Path("rgb.txt"), 0.02).message(),
              folder.Path("rgb.txt") + ": is a file; give the folder of a recorded sequence");
    EXPECT_EQ(Read(folder).message(), folder.path() + ": there is rgb.txt but no depth.txt");
    std::filesystem::remove(folder.Path("rgb.txt"));
    folder.WriteText("seq-01/frame-000000.color.png", "");
    EXPECT_EQ(Read(folder).message(),
              folder.path() + ": contains several sequences; give one of them, such as seq-01");
    std::filesystem::remove_all(folder.Path("seq-01"));
    folder.WriteText("notes.md", "");
    EXPECT_NE(Read(folder).message().find("not a known sequence layout"), std::string::npos);
}

TEST(ReadFolderLayout, NotesSingleAbsentFilesAndRefusesWhenAllAreAbsent) {
    TemporaryFolder folder;
    WriteTumLists(folder);
    folder.WriteText("camera.yaml", kTenHertzCamera);
    std::filesystem::remove(folder.Path("rgb/2.png"));
    const auto layout = Read(folder);
    ASSERT_TRUE(layout.ok()) << layout.message();
    EXPECT_EQ(layout.value().frames.size(), 2u);
    EXPECT_EQ(layout.value().notes,
              std::vector<std::string>{"1 of 2 frames lack an image (first: " +
                                       folder.Path("rgb/2.png") + "); they will be skipped"});
    std::filesystem::remove(folder.Path("depth/1.png"));
    EXPECT_EQ(Read(folder).message().find(folder.Path("depth/1.png") +
                                          ": no such file; none of the 2 frames"),
              0u);
}

}  // namespace
}  // namespace tessera
