#include "eval/detection_scores.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace tessera {
namespace {

// Boxes of 10 x 10 pixels.
DetectionBox At(float x, float y = 0) { return {x, y, x + 9, y + 9}; }

DetectionRow Row(const std::string& name, float probability, const DetectionBox& box) {
    return {0, name, probability, box};
}

// Instances 1 and 2 are cups, 3 is a book, 4 a cup of which little is visible, 5 a picture.
std::vector<ScoredImage> TwoImages() {
    return {
        {{{1, "cup", At(0)}, {2, "cup", At(20)}, {3, "book", At(40)}, {4, "cup", At(60), false}},
         {Row("book", 0.3f, At(40)), Row("cup", 0.9f, At(0)), Row("cup", 0.8f, At(1)),
          Row("cup", 0.7f, At(60)), Row("book", 0.6f, At(20))}},
        {{{1, "cup", At(0)}, {5, "picture", At(20)}},
         {Row("cup", 0.4f, At(80)), Row("cup", 0.6f, At(0)), Row("laptop", 0.95f, At(0))}}};
}

TEST(DetectionScores, ByClass) {
    const DetectionScores s = ScoreDetections(TwoImages(), {"cup", "book"}, 0.5);
    EXPECT_EQ(s.images, 2);
    EXPECT_NEAR(s.least_in_file, 0.3, 1e-6);
    ASSERT_EQ(s.classes.size(), 2u);
    // By probability: right, twice the same object, (too little of it visible), right, nothing.
    const DetectionScore& cup = s.classes.at("cup");
    EXPECT_EQ(cup.visible, 3);
    EXPECT_EQ(cup.detections, 3);
    EXPECT_EQ(cup.true_positives, 2);
    EXPECT_DOUBLE_EQ(cup.Precision(), 2.0 / 3);
    EXPECT_DOUBLE_EQ(cup.Recall(), 2.0 / 3);
    EXPECT_NEAR(cup.Probability(), (0.9 + 0.8 + 0.6) / 3, 1e-6);
    EXPECT_NEAR(cup.average_precision, (1 + 2.0 / 3) / 3, 1e-12);
    const DetectionScore& book = s.classes.at("book");
    EXPECT_EQ(book.detections, 1);
    EXPECT_EQ(book.true_positives, 0);
    EXPECT_NEAR(book.average_precision, 0.5, 1e-12);  // the right one is below 0.5
    EXPECT_EQ(s.all.visible, 4);
    EXPECT_EQ(s.all.detections, 4);
    EXPECT_DOUBLE_EQ(s.all.Precision(), 0.5);
    EXPECT_DOUBLE_EQ(s.all.Recall(), 0.5);
    EXPECT_NEAR(s.all.average_precision, (5.0 / 9 + 0.5) / 2, 1e-12);
    EXPECT_EQ(s.not_looked_for, (std::map<std::string, std::int64_t>{{"picture", 1}}));
}

TEST(DetectionScores, ByObject) {
    const DetectionScores s = ScoreDetections(TwoImages(), {"cup", "book"}, 0.5);
    ASSERT_EQ(s.objects.size(), 3u);
    EXPECT_EQ(s.objects.at(1).visible, 2);
    EXPECT_DOUBLE_EQ(s.objects.at(1).Pt(), 1);
    EXPECT_DOUBLE_EQ(s.objects.at(1).Pc(), 1);
    EXPECT_NEAR(s.objects.at(1).Probability(), 0.75, 1e-6);
    EXPECT_DOUBLE_EQ(s.objects.at(2).Pt(), 1);  // as a book
    EXPECT_DOUBLE_EQ(s.objects.at(2).Pc(), 0);
    EXPECT_DOUBLE_EQ(s.objects.at(3).Pt(), 0);
    EXPECT_DOUBLE_EQ(s.objects.at(3).Probability(), 0);
}

TEST(DetectionScores, PrecisionIsTheBestAtThisRecallOrMore) {
    ScoredImage image;
    for (int i = 0; i < 4; ++i)
        image.objects.push_back({i + 1, "cup", At(20 * static_cast<float>(i))});
    image.detections = {Row("cup", 0.9f, At(0)), Row("cup", 0.8f, At(200)),
                        Row("cup", 0.7f, At(20)), Row("cup", 0.6f, At(40))};
    // Precision 1, 1/2, 2/3, 3/4; recall 1/4, 1/4, 2/4, 3/4.
    EXPECT_NEAR(ScoreDetections({image}, {"cup"}, 0).all.average_precision, (1 + 0.75 + 0.75) / 4,
                1e-12);
}

TEST(DetectionScores, BoxesOverlapByHalf) {
    const auto correct = [](const DetectionBox& box) {
        return ScoreDetections({{{{1, "cup", At(0)}}, {Row("cup", 0.9f, box)}}}, {"cup"}, 0)
            .all.true_positives;
    };
    EXPECT_EQ(correct({0, 0, 19, 9}), 1);
    EXPECT_EQ(correct({0, 0, 20, 9}), 0);
}

// The boxes of two books in a stack overlap by more than half.
TEST(DetectionScores, ADetectionFindsOneObject) {
    const ScoredImage stack{{{1, "book", At(0, 0)}, {2, "book", At(0, 3)}},
                            {Row("book", 0.9f, At(0, 3))}};
    const DetectionScores s = ScoreDetections({stack}, {"book"}, 0.5);
    EXPECT_EQ(s.objects.at(1).detected, 0);
    EXPECT_EQ(s.objects.at(2).detected, 1);
    EXPECT_DOUBLE_EQ(s.all.Recall(), 0.5);
}

TEST(DetectionScores, AClassThatIsNotThereIsWrong) {
    const DetectionScores s = ScoreDetections(TwoImages(), {"cup", "book", "laptop"}, 0.5);
    EXPECT_EQ(s.classes.at("laptop").detections, 1);
    EXPECT_DOUBLE_EQ(s.classes.at("laptop").Precision(), 0);
    EXPECT_DOUBLE_EQ(s.all.Precision(), 2.0 / 5);
    EXPECT_NEAR(s.all.average_precision, (5.0 / 9 + 0.5) / 2, 1e-12);
    EXPECT_DOUBLE_EQ(s.objects.at(1).Pc(), 0.5);  // the laptop is more probable than the cup
}

TEST(DetectionScores, TextAndJson) {
    const DetectionScores s = ScoreDetections(TwoImages(), {"cup", "book"}, 0.5);
    const std::string text = DetectionScoresText(s);
    EXPECT_NE(text.find("not looked for, but visible: picture (1)"), std::string::npos) << text;
    const auto json = nlohmann::json::parse(DetectionScoresJson(s));
    EXPECT_NEAR(json["classes"]["cup"]["ap50"].get<double>(), 5.0 / 9, 1e-12);
    EXPECT_EQ(json["objects"][1]["instance"], 2);
    EXPECT_EQ(json["objects"][1]["pc"], 0);
    EXPECT_EQ(json["all"]["visible"], 4);
}

}  // namespace
}  // namespace tessera
