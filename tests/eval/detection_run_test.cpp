#include "eval/detection_run.h"

#include <gtest/gtest.h>

#include <fstream>

#include "io/image_io.h"
#include "support/temp_folder.h"

namespace tessera {
namespace {

// Two images of 64 x 48 pixels with a television (8 x 8 pixels, instance 1) and, in the second, two
// pixels of a cup, which are too few.
class DetectionRun : public testing::Test {
  protected:
    void SetUp() override {
        for (const char* name : {"depth", "labels", "instances", "run"})
            std::filesystem::create_directory(folder / name);
        Write("camera.yaml",
              "width: 64\nheight: 48\nfx: 50\nfy: 50\ncx: 31.5\ncy: 23.5\ndepth_scale: 5000\n");
        Write("groundtruth.txt", "1 0 0 0 0 0 0 1\n2 0 0 0 0 0 0 1\n");
        Write("depth.txt", "1 depth/1.png\n2 depth/2.png\n");
        Write("classes.txt", "3 tv\n4 cup\n");
        for (const int frame : {1, 2}) {
            Image<std::uint16_t> depth(64, 48, 5000), classes(64, 48, 0), instances(64, 48, 0);
            for (int y = 10; y < 18; ++y)
                for (int x = 20; x < 28; ++x) classes(x, y) = 3, instances(x, y) = 1;
            for (int x = 0; x < 2 * frame - 2; ++x) classes(x, 0) = 4, instances(x, 0) = 2;
            const std::string file = "/" + std::to_string(frame) + ".png";
            ASSERT_TRUE(WriteDepthImage(folder / "depth" + file, depth).ok());
            ASSERT_TRUE(WriteDepthImage(folder / "labels" + file, classes).ok());
            ASSERT_TRUE(WriteDepthImage(folder / "instances" + file, instances).ok());
        }
    }
    void Write(const std::string& name, const std::string& text) {
        std::ofstream(folder / name) << text;
    }
    DetectionScores Score(const std::string& name, const ClassAliases& aliases = {}) {
        const auto scores = EvaluateDetections(folder.path(), folder / name, aliases, 0.5);
        EXPECT_TRUE(scores.ok()) << scores.message();
        return scores.ok() ? scores.value() : DetectionScores{};
    }
    void ExpectRefused(const std::string& sequence, const std::string& name,
                       const std::string& named) {
        const auto scores = EvaluateDetections(sequence, folder / name, {}, 0.5);
        ASSERT_FALSE(scores.ok());
        EXPECT_NE(scores.message().find(named), std::string::npos) << scores.message();
    }
    TempFolder folder;
};

TEST_F(DetectionRun, AFileThatDoesNotSayLookedAtAllImages) {
    Write("d.txt", "1 tv 0.9 20 10 27 17\n");
    const DetectionScores s = Score("d.txt");
    EXPECT_EQ(s.images, 2);
    EXPECT_EQ(s.classes.at("tv").visible, 2);
    EXPECT_DOUBLE_EQ(s.classes.at("tv").Recall(), 0.5);
    EXPECT_TRUE(s.not_looked_for.empty());  // too little of the cup
}

TEST_F(DetectionRun, ARunSaysWhatItLookedAtAndLookedFor) {
    Write("run/detections.txt",
          "# classes computer cup\n# aliases tv=computer\n# frame 1.001\n1.001 computer 0.9 20 10 "
          "27 17\n");
    const DetectionScores s = Score("run");
    EXPECT_EQ(s.images, 1);
    EXPECT_DOUBLE_EQ(s.classes.at("computer").Recall(), 1);
    Write("run/detections.txt", "# classes cup\n# aliases\n# frame 1\n# frame 2\n");
    EXPECT_EQ(Score("run", {{"tv", "computer"}}).not_looked_for,
              (std::map<std::string, std::int64_t>{{"tv", 2}}));
}

TEST_F(DetectionRun, AliasesRenameBothSides) {
    Write("d.txt", "1 monitor 0.9 20 10 27 17\n");
    EXPECT_EQ(Score("d.txt").all.true_positives, 0);
    const DetectionScores s = Score("d.txt", {{"tv", "computer"}, {"monitor", "computer"}});
    EXPECT_EQ(s.classes.at("computer").true_positives, 1);
}

TEST_F(DetectionRun, BadInputIsNamed) {
    Write("d.txt", "1 tv 0.9 20 10 27 17\n1 tv 2 20 10 27 17\n");
    ExpectRefused(folder.path(), "d.txt", "d.txt:2: probability");
    ExpectRefused(folder.path(), "run", "--labels");
    Write("late.txt", "# frame 9\n9 tv 0.9 20 10 27 17\n");
    ExpectRefused(folder.path(), "late.txt", "late.txt");
    ExpectRefused(folder / "run", "d.txt", "tessera synth");
}

}  // namespace
}  // namespace tessera
