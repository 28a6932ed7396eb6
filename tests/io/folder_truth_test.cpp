#include "io/folder_truth.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/se3.h"
#include "io/temporary_folder.h"

namespace tessera {
namespace {

FolderLayout FramesAt(const std::vector<double>& stamps_s) {
    FolderLayout layout;
    for (double stamp_s : stamps_s) {
        FolderFrame frame;
        frame.depth_stamp_s = stamp_s;
        layout.frames.push_back(frame);
    }
    return layout;
}

TEST(AddTruth, InterpolatesAtTheDepthStamp) {
    TemporaryFolder folder;
    folder.WriteText("groundtruth.txt",
                     "1.00 0 0 0 0 0 0 1\n1.04 4 0 0 0 0 0 1\n9.0 0 0 0 0 0 0 1\n");
    FolderLayout layout = FramesAt({1.01, 1.04, 5.0});
    AddTruth(folder.path(), false, layout);
    ASSERT_TRUE(layout.frames[0].T_world_camera.has_value());
    EXPECT_NEAR(layout.frames[0].T_world_camera->translation().x(), 1.0, 1e-9);
    EXPECT_NEAR(layout.frames[1].T_world_camera->translation().x(), 4.0, 1e-9);
    EXPECT_FALSE(layout.frames[2].T_world_camera.has_value());
    EXPECT_EQ(layout.notes,
              std::vector<std::string>{"1 of 3 frames have no ground truth at their time"});
}

TEST(AddTruth, NotesWhatCannotBeUsedAndGoesOn) {
    TemporaryFolder folder;
    folder.WriteText("groundtruth.txt",
                     "1.0 0 0 0 0 0 0 1\n2.0 nan 0 0 0 0 0 1\n3.0 3 0 0 0 0 0 1\n");
    FolderLayout layout = FramesAt({1.0, 3.0});
    AddTruth(folder.path(), false, layout);
    EXPECT_TRUE(layout.frames[0].T_world_camera && layout.frames[1].T_world_camera);
    ASSERT_EQ(layout.notes.size(), 1u);
    EXPECT_NE(layout.notes[0].find("groundtruth.txt:2"), std::string::npos) << layout.notes[0];

    folder.WriteText("groundtruth.txt", "this is no trajectory\n");
    layout = FramesAt({1.0});
    AddTruth(folder.path(), false, layout);
    EXPECT_FALSE(layout.frames[0].T_world_camera.has_value());
    ASSERT_EQ(layout.notes.size(), 1u);
    EXPECT_EQ(layout.notes[0].find("ground truth is not used: "), 0u);
}

// ICL-NUIM's camera has y up: a point projects with fy = -480. The same pixel and depth,
// unprojected with our fy = 480, must give the same point in the reflected world.
TEST(AddTruth, ReflectsIclNuimsPosesToOurAxes) {
    TemporaryFolder folder;
    folder.WriteText("livingRoom0.gt.freiburg", "7 0.5 0.25 -1.5 0.1 0.2 0.3 0.9273618495495703\n");
    FolderLayout layout = FramesAt({7, 8});
    AddTruth(folder.path(), true, layout);
    ASSERT_TRUE(layout.frames[0].T_world_camera.has_value());
    EXPECT_FALSE(layout.frames[1].T_world_camera.has_value());
    const Eigen::Isometry3d& T_world_camera = *layout.frames[0].T_world_camera;
    EXPECT_NEAR(T_world_camera.linear().determinant(), 1.0, 1e-9);

    Eigen::Isometry3d T_icl = Eigen::Isometry3d::Identity();
    T_icl.linear() = Eigen::Quaterniond(0.9273618495495703, 0.1, 0.2, 0.3).toRotationMatrix();
    T_icl.translation() = Eigen::Vector3d(0.5, 0.25, -1.5);
    const double u = 100, v = 50, z = 2;
    const Eigen::Vector3d p_icl_camera((u - 319.5) / 481.2 * z, (v - 239.5) / -480.0 * z, z);
    const Eigen::Vector3d p_icl_world = T_icl * p_icl_camera;
    const PinholeCamera ours{640, 480, 481.2, 480.0, 319.5, 239.5};
    const Eigen::Vector3d p_world = T_world_camera * ours.Unproject(u, v, z);
    EXPECT_NEAR(
        (p_world - Eigen::Vector3d(p_icl_world.x(), -p_icl_world.y(), p_icl_world.z())).norm(), 0,
        1e-9);
}

TEST(AddTruth, ReadsSevenScenesPoses) {
    TemporaryFolder folder;
    folder.WriteText("frame-000000.pose.txt", "0 -1 0 1\n1 0 0 2\n0 0 1 3\n0 0 0 1\n");
    folder.WriteText("frame-000001.pose.txt", "nan 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n");
    folder.WriteText("frame-000002.pose.txt", "2 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n");
    folder.WriteText("frame-000003.pose.txt", "1 0 0 0\n0 1 0");
    FolderLayout layout = FramesAt({0, 1, 2, 3, 4});
    layout.kind = "7-Scenes sequence";
    for (std::size_t i = 0; i < 5; ++i)
        layout.frames[i].depth_path = folder.Path("frame-00000" + std::to_string(i) + ".depth.png");
    AddTruth(folder.path(), false, layout);
    ASSERT_TRUE(layout.frames[0].T_world_camera.has_value());
    EXPECT_EQ((*layout.frames[0].T_world_camera * Eigen::Vector3d(1, 0, 0)),
              Eigen::Vector3d(1, 3, 3));
    for (std::size_t i = 1; i < 5; ++i)
        EXPECT_FALSE(layout.frames[i].T_world_camera.has_value()) << i;
    EXPECT_EQ(layout.notes, std::vector<std::string>{"4 of 5 frames have no usable .pose.txt"});
}

}  // namespace
}  // namespace tessera
