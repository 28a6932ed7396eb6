#include "io/trajectory.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>

#include "core/input_file.h"
#include "io/file.h"

namespace tessera {
namespace {

// Tests run in parallel, so each uses its own file.
std::string TrajectoryPath() {
    return testing::TempDir() + "trajectory_" +
           testing::UnitTest::GetInstance()->current_test_info()->name() + ".txt";
}

Result<Trajectory> ReadText(const std::string& text) {
    const std::string path = TrajectoryPath();
    EXPECT_TRUE(WriteTextFile(path, text).ok());
    return ReadTrajectory(path);
}

StampedPose Pose(double stamp_s, const Eigen::Vector3d& t, const Eigen::Quaterniond& q) {
    StampedPose pose;
    pose.stamp_s = stamp_s;
    pose.T_world_camera.linear() = q.toRotationMatrix();
    pose.T_world_camera.translation() = t;
    return pose;
}

TEST(Trajectory, ReadsQuaternionAsXyzw) {
    const auto result = ReadText("1.5 1 2 3 0 0 0.7071067811865476 0.7071067811865476\n");
    ASSERT_TRUE(result.ok()) << result.message();
    ASSERT_EQ(result.value().poses.size(), 1u);
    const StampedPose& pose = result.value().poses[0];
    EXPECT_EQ(pose.stamp_s, 1.5);
    // A quarter turn about z maps x to y.
    const Eigen::Vector3d p = pose.T_world_camera * Eigen::Vector3d::UnitX();
    EXPECT_LT((p - Eigen::Vector3d(1, 3, 3)).norm(), 1e-12);
}

TEST(Trajectory, RoundTrip) {
    std::vector<StampedPose> poses;
    for (int i = 0; i < 20; ++i)
        poses.push_back(Pose(1305031102.175304 + 0.033 * i, {0.1 * i, -0.2, 3.0},
                             Eigen::Quaterniond(std::cos(i), std::sin(i), 0.3, -0.2).normalized()));
    const std::string path = TrajectoryPath();
    ASSERT_TRUE(WriteTrajectory(path, poses).ok());
    const auto result = ReadTrajectory(path);
    ASSERT_TRUE(result.ok()) << result.message();
    EXPECT_TRUE(result.value().notes.empty());
    ASSERT_EQ(result.value().poses.size(), poses.size());
    for (std::size_t i = 0; i < poses.size(); ++i) {
        const StampedPose& back = result.value().poses[i];
        EXPECT_NEAR(back.stamp_s, poses[i].stamp_s, 1e-6);
        EXPECT_LT((back.T_world_camera.matrix() - poses[i].T_world_camera.matrix()).norm(), 1e-8);
    }
}

TEST(Trajectory, LineHasFixedDecimalsAndOneQuaternionSign) {
    const Eigen::Quaterniond q(-0.5, 0.5, 0.5, 0.5);
    EXPECT_EQ(TrajectoryLine(Pose(12.25, {1, -2, 0.125}, q)),
              "12.250000 1.000000000 -2.000000000 0.125000000 -0.500000000 -0.500000000 "
              "-0.500000000 0.500000000");
}

TEST(Trajectory, KittiLinesAreThreeRowsAndTheStampsLieBeside) {
    const Eigen::Quaterniond quarter(Eigen::AngleAxisd(M_PI / 2, Eigen::Vector3d::UnitZ()));
    const std::string path = TrajectoryPath();
    const Eigen::Quaterniond identity = Eigen::Quaterniond::Identity();
    ASSERT_TRUE(WriteKittiPoses(
                    path, {Pose(12.25, {1, -2, 0.125}, quarter), Pose(12.5, {0, 0, 3}, identity)})
                    .ok());
    EXPECT_EQ(ReadWholeFile(path + ".times", 1000).value(), "12.250000\n12.500000\n");
    const std::string text = ReadWholeFile(path, 1000).value();
    std::stringstream numbers(text);
    const double expected[] = {0, -1, 0, 1, 1, 0, 0, -2, 0, 0, 1, 0.125,
                               1, 0,  0, 0, 0, 1, 0, 0,  0, 0, 1, 3};
    for (const double e : expected) {
        double value = 9;
        numbers >> value;
        EXPECT_NEAR(value, e, 1e-9);
    }
    EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 2);
}

TEST(Trajectory, TakesCrlfCommentsTabsCommasAndByteOrderMark) {
    const auto result = ReadText(
        "\xef\xbb\xbf# ground truth\r\n\r\n1\t0 0 0 0 0 0 1\r\n"
        "  2,0,0,0, 0,0,0,1 # a remark\r\n3 +1e0 0 0 0 0 0 1");
    ASSERT_TRUE(result.ok()) << result.message();
    EXPECT_EQ(result.value().poses.size(), 3u);
    EXPECT_EQ(result.value().poses[2].T_world_camera.translation().x(), 1.0);
    EXPECT_TRUE(result.value().notes.empty());
}

TEST(Trajectory, SkipsAndNotesBadLines) {
    const auto result = ReadText(
        "1 0 0 0 0 0 0 1\n"
        "2 NaN 0 0 0 0 0 1\n"
        "3 0 inf 0 0 0 0 1\n"
        "4 0 0 0 0 0 0 0\n"
        "5 0 0 0 0 0 1\n"
        "6 1e300 0 0 0 0 0 1\n"
        "1 9 9 9 0 0 0 1\n"
        "nan 0 0 0 0 0 0 1\n"
        "8 0 0 0 0 0 1e200 1e200\n");
    ASSERT_TRUE(result.ok()) << result.message();
    const Trajectory& trajectory = result.value();
    ASSERT_EQ(trajectory.poses.size(), 2u);
    EXPECT_EQ(trajectory.poses[0].T_world_camera.translation().x(), 0.0);  // the first duplicate
    EXPECT_EQ(trajectory.poses[1].stamp_s, 8.0);
    EXPECT_NEAR(trajectory.poses[1].T_world_camera(1, 0), 1.0, 1e-12);
    std::string notes;
    for (const std::string& note : trajectory.notes) notes += note + "\n";
    for (const char* expected :
         {":2: not a finite", ":3: not a finite", ":4: zero quaternion", ":5: 7 numbers",
          ":6: more than 1000 km", ":7: repeated stamp 1.000000", ":8: not a finite"})
        EXPECT_NE(notes.find(expected), std::string::npos) << expected << "\nin\n" << notes;
}

TEST(Trajectory, NormalisesQuaternions) {
    const auto result = ReadText("1 0 0 0 0 0 3 4\n");
    ASSERT_TRUE(result.ok());
    const Eigen::Matrix3d R = result.value().poses[0].T_world_camera.linear();
    EXPECT_NEAR(R.determinant(), 1.0, 1e-12);
    EXPECT_NEAR(R(0, 0), 1 - 2 * 0.6 * 0.6, 1e-12);
}

TEST(Trajectory, SortsBackwardStamps) {
    const auto result = ReadText("2 2 0 0 0 0 0 1\n1 1 0 0 0 0 0 1\n3 3 0 0 0 0 0 1\n");
    ASSERT_TRUE(result.ok());
    ASSERT_EQ(result.value().poses.size(), 3u);
    for (int i = 0; i < 3; ++i)
        EXPECT_EQ(result.value().poses[static_cast<std::size_t>(i)].T_world_camera(0, 3), i + 1.0);
    ASSERT_EQ(result.value().notes.size(), 1u);
    EXPECT_NE(result.value().notes[0].find(":2: stamps run backwards"), std::string::npos);
}

TEST(Trajectory, ALineCutOffAtTheEndIsSkipped) {
    const auto result = ReadText("1 0 0 0 0 0 0 1\n2 0 0 -");
    ASSERT_TRUE(result.ok()) << result.message();
    EXPECT_EQ(result.value().poses.size(), 1u);
    EXPECT_EQ(result.value().notes.size(), 1u);
}

TEST(Trajectory, ErrorsNameFileAndLine) {
    const auto words = ReadText("1 0 0 0 0 0 0 1\nstamp x y z\n");
    ASSERT_FALSE(words.ok());
    EXPECT_NE(words.message().find(TrajectoryPath() + ":2: 'stamp' is not a number"),
              std::string::npos)
        << words.message();
    EXPECT_NE(ReadText("").message().find("contains no pose"), std::string::npos);
    EXPECT_NE(ReadText("# only\n").message().find("contains no pose"), std::string::npos);
    EXPECT_NE(ReadText("1 nan 0 0 0 0 0 1\n").message().find("not a finite"), std::string::npos);
    EXPECT_FALSE(ReadTrajectory(testing::TempDir()).ok());
    EXPECT_FALSE(ReadTrajectory(testing::TempDir() + "absent.txt").ok());
    EXPECT_FALSE(ReadText(std::string(5000, '\0') + "\n").ok());
}

TEST(Trajectory, NotesAreBounded) {
    std::string text = "1 0 0 0 0 0 0 1\n";
    for (int i = 0; i < 1000; ++i) text += "1 0 0 0 0 0 0 1\n";
    const auto result = ReadText(text);
    ASSERT_TRUE(result.ok());
    EXPECT_EQ(result.value().notes.size(), 51u);
    EXPECT_NE(result.value().notes.back().find("950 more"), std::string::npos);
}

TEST(Trajectory, IsSplitWhereTheClockStartsAgain) {
    std::vector<StampedPose> poses;
    for (const double stamp_s : {10.0, 10.1, 10.05, 900.0, 10.0, 10.1, 3.0})  // 10.05: jitter
        poses.push_back({stamp_s, Eigen::Isometry3d::Identity()});
    const auto parts = SplitByClock(poses);
    ASSERT_EQ(parts.size(), 3u);
    EXPECT_EQ(parts[0].size(), 4u);
    EXPECT_EQ(parts[1].size(), 2u);
    EXPECT_EQ(parts[2].front().stamp_s, 3.0);
    EXPECT_EQ(SplitByClock({}).size(), 1u);
    const std::string path = testing::TempDir() + "clocks.txt";
    ASSERT_TRUE(WriteTrajectory(path, poses).ok());
    EXPECT_EQ(ReadTrajectory(NumberedPath(path, 1)).value().poses.size(), 4u);
    EXPECT_EQ(ReadTrajectory(testing::TempDir() + "clocks_2.txt").value().poses.size(), 2u);
    EXPECT_EQ(ReadTrajectory(path).value().poses.size(), 1u);
}

TEST(Trajectory, InterpolatesHalfWay) {
    const Eigen::Quaterniond quarter(Eigen::AngleAxisd(M_PI / 2, Eigen::Vector3d::UnitZ()));
    const std::vector<StampedPose> poses = {Pose(1.0, {0, 0, 0}, Eigen::Quaterniond::Identity()),
                                            Pose(1.1, {1, 2, 3}, quarter)};
    const auto T = InterpolatePose(poses, 1.05, 0.2);
    ASSERT_TRUE(T.has_value());
    EXPECT_LT((T->translation() - Eigen::Vector3d(0.5, 1, 1.5)).norm(), 1e-9);
    EXPECT_NEAR(RotationAngle(*T, poses[0].T_world_camera), M_PI / 4, 1e-9);
}

TEST(Trajectory, InterpolatesNothingOutsideOrAcrossGaps) {
    const Eigen::Quaterniond identity = Eigen::Quaterniond::Identity();
    const std::vector<StampedPose> poses = {Pose(1, {1, 0, 0}, identity),
                                            Pose(2, {2, 0, 0}, identity)};
    EXPECT_FALSE(InterpolatePose(poses, 1.5).has_value());
    EXPECT_TRUE(InterpolatePose(poses, 1.5, 1.0).has_value());
    EXPECT_FALSE(InterpolatePose(poses, 0.99, 10).has_value());
    EXPECT_FALSE(InterpolatePose(poses, 2.01, 10).has_value());
    EXPECT_FALSE(InterpolatePose(poses, std::nan(""), 10).has_value());
    EXPECT_FALSE(InterpolatePose({}, 1, 10).has_value());
    EXPECT_EQ(InterpolatePose(poses, 2.0)->translation().x(), 2.0);  // exact, so no gap
    EXPECT_EQ(InterpolatePose(poses, 1.0)->translation().x(), 1.0);
}

TEST(Trajectory, TakesTheNearestPoseWhereItDoesNotInterpolate) {
    const Eigen::Quaterniond identity = Eigen::Quaterniond::Identity();
    const std::vector<StampedPose> slow = {Pose(1, {1, 0, 0}, identity),
                                           Pose(1.2, {2, 0, 0}, identity)};
    EXPECT_EQ(PoseAt(slow, 1.001)->translation().x(), 1.0);
    EXPECT_EQ(PoseAt(slow, 1.185)->translation().x(), 2.0);
    EXPECT_EQ(PoseAt(slow, 0.985)->translation().x(), 1.0);  // before the first
    EXPECT_EQ(PoseAt(slow, 1.215)->translation().x(), 2.0);  // after the last
    EXPECT_FALSE(PoseAt(slow, 1.021).has_value());
    EXPECT_FALSE(PoseAt(slow, 1.25).has_value());
    EXPECT_FALSE(PoseAt(slow, std::nan("")).has_value());
    EXPECT_FALSE(PoseAt({}, 1).has_value());
    const std::vector<StampedPose> fast = {Pose(1, {1, 0, 0}, identity),
                                           Pose(1.02, {2, 0, 0}, identity)};
    EXPECT_NEAR(PoseAt(fast, 1.005)->translation().x(), 1.25, 1e-9);  // interpolated
}

}  // namespace
}  // namespace tessera
