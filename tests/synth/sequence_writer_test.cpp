#include "synth/sequence_writer.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "io/image_io.h"
#include "io/mesh_io.h"
#include "io/trajectory.h"
#include "support/temp_folder.h"
#include "synth/analytic_scene.h"
#include "synth/furniture.h"
#include "synth/paint.h"
#include "synth/seen_objects.h"

namespace tessera {
namespace {

// A wall with a cup in front of it, and a second cup that is never in view.
StagedScene TwoCups() {
    auto scene = std::make_unique<AnalyticScene>();
    Furnisher add(*scene);
    add.Box(StandAt(0, 2.05, -2), {0, 0, 0}, {8, 0.1, 6}, add.Flat({100, 120, 140}));
    add.Cup(StandAt(0.0, 1.0, 0.95), "cup 1", {230, 230, 230}, {40, 40, 200});
    add.Cup(StandAt(0.0, -5.0, 0.95), "cup 2", {230, 230, 230}, {40, 40, 200});
    Lighting even;
    even.baked = false;
    scene->Finish(even);
    StagedScene staged;
    staged.scene = std::move(scene);
    staged.path.duration_s = 1;
    staged.path.T_world_camera = [](double t) { return LookAt({0.1 * t, 0, 1}, {0, 2, 1}); };
    return staged;
}

SynthConfig SmallSequence() {
    SynthConfig config;
    config.camera = {80, 60, 65, 65, 39.5, 29.5};
    config.frames = 5;
    return config;
}

std::string Slurp(const std::string& path) {
    std::stringstream text;
    text << std::ifstream(path).rdbuf();
    return text.str();
}

class WrittenSequence : public testing::Test {
  protected:
    void SetUp() override {
        folder_ = ProcessFolder() + "/written_sequence";
        std::filesystem::remove_all(folder_);
        SyntheticSource source("two cups", TwoCups(), SmallSequence());
        const auto summary =
            WriteSequence(source, folder_, [this](std::int64_t done, std::int64_t total) {
                EXPECT_EQ(total, 5);
                progress_ = done;
                return true;
            });
        ASSERT_TRUE(summary.ok()) << summary.message();
        EXPECT_EQ(summary.value().frames, 5);
        EXPECT_NEAR(summary.value().path_m, 0.1 * 4 / 30, 1e-9);
    }
    std::string folder_;
    std::int64_t progress_ = 0;
};

TEST_F(WrittenSequence, HoldsTheFramesAsTheSourceGivesThem) {
    EXPECT_EQ(progress_, 5);
    SyntheticSource source("two cups", TwoCups(), SmallSequence());
    Frame frame;
    RenderedView truth;
    ASSERT_TRUE(source.Seek(2));
    ASSERT_EQ(source.ReadWithTruth(frame, truth).status, ReadStatus::kOk);
    const std::string file = "/1000.066667.png";
    EXPECT_EQ(ReadColourImage(folder_ + "/rgb" + file).value(), frame.colour);
    EXPECT_EQ(ReadDepthImage(folder_ + "/labels" + file).value(), truth.class_id);
    EXPECT_EQ(ReadDepthImage(folder_ + "/instances" + file).value(), truth.instance);
    const auto depth = ReadDepthImage(folder_ + "/depth" + file);
    ASSERT_TRUE(depth.ok());
    for (std::size_t i = 0; i < depth.value().size(); ++i)
        ASSERT_NEAR(depth.value().data()[i] / 5000.0, frame.depth_m.data()[i], 1.01e-4);
    const auto poses = ReadTrajectory(folder_ + "/groundtruth.txt");
    ASSERT_TRUE(poses.ok());
    ASSERT_EQ(poses.value().poses.size(), 5u);
    EXPECT_TRUE(poses.value().poses[2].T_world_camera.isApprox(*frame.T_world_camera, 1e-6));
    EXPECT_EQ(ReadCameraFile(folder_ + "/camera.yaml").value().pinhole, SmallSequence().camera);
    EXPECT_NE(Slurp(folder_ + "/rgb.txt").find("\n1000.066667 rgb/1000.066667.png\n"),
              std::string::npos);
    EXPECT_NE(Slurp(folder_ + "/depth.txt").find("\n1000.133333 depth/1000.133333.png\n"),
              std::string::npos);
}

TEST_F(WrittenSequence, ListsOnlyWhatWasSeen) {
    const auto objects = nlohmann::json::parse(Slurp(folder_ + "/objects.json"));
    ASSERT_EQ(objects.size(), 1u);
    EXPECT_EQ(objects[0]["name"], "cup 1");
    EXPECT_EQ(objects[0]["class"], "cup");
    EXPECT_EQ(objects[0]["frames_visible"], 5);
    EXPECT_NEAR(objects[0]["aabb_max"][2], 0.95 + 0.098, 1e-3);
    EXPECT_NE(Slurp(folder_ + "/classes.txt").find("\n1 cup\n"), std::string::npos);
}

TEST_F(WrittenSequence, TheReferenceIsTheSeenPartOnTheSurface) {
    const auto reference = ReadPly(folder_ + "/reference.ply");
    ASSERT_TRUE(reference.ok()) << reference.message();
    const StagedScene staged = TwoCups();
    ASSERT_GT(reference.value().triangles.size(), 100u);
    for (const auto& v : reference.value().vertices) {
        EXPECT_GT(v.y(), 0.5f);    // not the cup behind the camera
        EXPECT_LT(v.y(), 2.001f);  // not the back of the wall
        // The cup's handle reaches 3 mm into the cup's side.
        EXPECT_LT(*staged.scene->SignedDistance(v.cast<double>()), 1e-5);
        EXPECT_GT(*staged.scene->SignedDistance(v.cast<double>()), -0.004);
    }
}

TEST(SequenceWriter, TheReferenceLeavesOutWhatTheSensorCannotMeasure) {
    const std::string folder = ProcessFolder() + "/short_sighted_sequence";
    std::filesystem::remove_all(folder);
    SynthConfig config = SmallSequence();
    config.sensor.noise = NoiseModel::kKinect;
    config.sensor.max_depth_m = 1.5;  // the wall is 2 m away
    SyntheticSource source("two cups", TwoCups(), config);
    ASSERT_TRUE(WriteSequence(source, folder, {}).ok());
    const auto reference = ReadPly(folder + "/reference.ply");
    ASSERT_TRUE(reference.ok()) << reference.message();
    ASSERT_GT(reference.value().triangles.size(), 20u);
    for (const auto& v : reference.value().vertices) EXPECT_LT(v.y(), 1.5f);
}

TEST(SequenceWriter, StopsWhenAskedAndLeavesAWholeFolder) {
    const std::string folder = ProcessFolder() + "/stopped_sequence";
    std::filesystem::remove_all(folder);
    SyntheticSource source("two cups", TwoCups(), SmallSequence());
    const auto summary =
        WriteSequence(source, folder, [](std::int64_t done, std::int64_t) { return done < 2; });
    ASSERT_TRUE(summary.ok()) << summary.message();
    EXPECT_EQ(summary.value().frames, 2);
    EXPECT_EQ(ReadTrajectory(folder + "/groundtruth.txt").value().poses.size(), 2u);
}

TEST(SequenceWriter, AFolderThatCannotBeMadeIsAnError) {
    SyntheticSource source("two cups", TwoCups(), SmallSequence());
    const auto summary = WriteSequence(source, "/proc/nowhere", {});
    ASSERT_FALSE(summary.ok());
    EXPECT_NE(summary.message().find("/proc/nowhere"), std::string::npos);
}

TEST(SequenceWriter, ReplacesASequenceButNoRecording) {
    const std::string folder = ProcessFolder() + "/a_recording", list = folder + "/rgb.txt";
    std::filesystem::remove_all(folder);
    std::filesystem::create_directory(folder);
    std::ofstream(list) << "mine";
    SyntheticSource source("two cups", TwoCups(), SmallSequence());
    const WriteProgress one = [](std::int64_t, std::int64_t) { return false; };
    const auto refused = WriteSequence(source, folder, one);
    ASSERT_FALSE(refused.ok());
    EXPECT_EQ(refused.message().find(list + ": would be replaced"), 0u) << refused.message();
    EXPECT_EQ(std::filesystem::file_size(list), 4u);
    EXPECT_FALSE(std::filesystem::exists(folder + "/rgb"));
    std::filesystem::remove(list);
    EXPECT_TRUE(WriteSequence(source, folder, one).ok());
    EXPECT_TRUE(WriteSequence(source, folder, one).ok());
}

// In the lists, a blank ends a word and # begins a comment.
TEST(SeenObjects, NamesOfClassesAreOneWordInTheLists) {
    AnalyticScene scene;
    Furnisher add(scene);
    scene.BeginInstance("a", "oak\tchair #");
    add.Box(StandAt(0, 0, 0), {0, 0, 0}, {1, 1, 1}, add.Flat({1, 2, 3}));
    RenderedView view;
    view.instance = Image<std::uint16_t>(64, 48, 1);
    SeenObjects objects(scene, 3);
    for (int i = 0; i < 10; ++i) objects.Add(view, i, i);
    EXPECT_NE(objects.ClassesText().find("\n1 oak_chair__\n"), std::string::npos);
    EXPECT_NE(objects.DetectionsText().find(" oak_chair__ 0."), std::string::npos);
}

// Checks the stated error rates of the synthetic detector over many frames of one view.
TEST(SeenObjects, DetectionsHaveTheirStatedMistakes) {
    AnalyticScene scene;
    Furnisher add(scene);
    add.Cup(StandAt(0, 0, 0), "cup 1", {230, 230, 230}, {40, 40, 200});
    add.Keyboard(StandAt(0, 1, 0), "keyboard 1");
    RenderedView view;
    view.instance = Image<std::uint16_t>(64, 48);
    for (int y = 10; y < 30; ++y)
        for (int x = 20; x < 50; ++x) view.instance(x, y) = 1;
    SeenObjects objects(scene, 3);
    constexpr int kFrames = 4000;
    for (int i = 0; i < kFrames; ++i) objects.Add(view, i, i);
    std::stringstream lines(objects.DetectionsText());
    std::string line;
    std::getline(lines, line);
    int found = 0, wrong = 0;
    double sum = 0;
    while (std::getline(lines, line)) {
        std::stringstream words(line);
        std::string name;
        double stamp, p;
        int x0, y0, x1, y1;
        ASSERT_TRUE(words >> stamp >> name >> p >> x0 >> y0 >> x1 >> y1);
        EXPECT_EQ(std::vector<int>({x0, y0, x1, y1}), std::vector<int>({20, 10, 49, 29}));
        ++found;
        wrong += name != "cup";
        sum += p;
    }
    EXPECT_NEAR(found, 0.90 * kFrames, 0.02 * kFrames);
    EXPECT_NEAR(wrong, 0.027 * kFrames, 0.01 * kFrames);
    EXPECT_NEAR(sum / found, 0.9, 0.01);
}

}  // namespace
}  // namespace tessera
