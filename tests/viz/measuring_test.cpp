#include "viz/measuring.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "support/temp_folder.h"

namespace tessera {
namespace {

void Click(Measuring& measuring, double x, double y, double z = 0) {
    measuring.Click({x, y, z}, false, false);
}
void ClickFirst(Measuring& measuring) { measuring.Click({9, 9, 9}, true, false); }

// A square of 2 m.
void ClickSquare(Measuring& measuring) {
    Click(measuring, 0, 0);
    Click(measuring, 2, 0);
    Click(measuring, 2, 2);
    Click(measuring, 0, 2);
    ClickFirst(measuring);
}

TEST(Measuring, ClicksBecomeALine) {
    Measuring measuring;
    measuring.Toggle();
    EXPECT_TRUE(measuring.on());
    EXPECT_EQ(measuring.open(), nullptr);
    Click(measuring, 0, 0);
    Click(measuring, 3, 0);
    Click(measuring, 3, 4);
    ASSERT_NE(measuring.open(), nullptr);
    EXPECT_EQ(Length_m(*measuring.open()), 7);
    measuring.Finish();
    EXPECT_EQ(measuring.open(), nullptr);
    Click(measuring, 5, 5);
    ASSERT_EQ(measuring.all().size(), 2u);
    EXPECT_EQ(measuring.all()[1].corners.size(), 1u);
    measuring.Finish();  // a point alone is nothing
    EXPECT_EQ(measuring.all().size(), 1u);
    EXPECT_EQ(measuring.all()[0].corners.size(), 3u);
}

TEST(Measuring, TheFirstCornerClosesAnArea) {
    Measuring measuring;
    ClickSquare(measuring);
    ASSERT_EQ(measuring.all().size(), 1u);
    EXPECT_TRUE(measuring.all()[0].closed);
    EXPECT_EQ(Area_m2(measuring.all()[0]), 4);
    EXPECT_EQ(measuring.open(), nullptr);
    measuring.Click({7, 7, 3}, false, true);
    EXPECT_EQ(Volume_m3(measuring.all()[0]), 12);
    EXPECT_EQ(measuring.all().size(), 1u);
    Click(measuring, 1, 1);  // without Shift: another measurement
    EXPECT_EQ(measuring.all().size(), 2u);
}

// Two corners have no area: the second click on the first is a way back.
TEST(Measuring, TwoCornersCannotBeClosed) {
    Measuring measuring;
    Click(measuring, 0, 0);
    Click(measuring, 2, 0);
    measuring.Click({0, 0, 0}, true, false);
    EXPECT_FALSE(measuring.all()[0].closed);
    EXPECT_EQ(measuring.all()[0].corners.size(), 3u);
    measuring.Click({5, 0, 0}, false, true);  // Shift over a line is a corner, too
    EXPECT_EQ(measuring.all()[0].corners.size(), 4u);
}

TEST(Measuring, ClicksAreTakenBackOneByOne) {
    Measuring measuring;
    ClickSquare(measuring);
    measuring.Click({7, 7, 3}, false, true);
    measuring.TakeBack();
    EXPECT_FALSE(measuring.all()[0].top);
    EXPECT_TRUE(measuring.all()[0].closed);
    measuring.TakeBack();
    EXPECT_FALSE(measuring.all()[0].closed);
    ASSERT_NE(measuring.open(), nullptr);
    EXPECT_EQ(measuring.open()->corners.size(), 4u);
    for (int i = 0; i < 3; ++i) measuring.TakeBack();
    ASSERT_NE(measuring.open(), nullptr);
    EXPECT_EQ(measuring.open()->corners.size(), 1u);
    measuring.TakeBack();
    EXPECT_TRUE(measuring.all().empty());
    EXPECT_EQ(measuring.open(), nullptr);
    measuring.TakeBack();  // nothing is left
    EXPECT_TRUE(measuring.all().empty());
}

TEST(Measuring, WhatWasClearedComesBackUntilTheNextClick) {
    const TempFolder folder;
    const std::string file = MeasurementsFile(folder.path());
    Measuring measuring;
    measuring.Open(file);
    ClickSquare(measuring);
    Click(measuring, 5, 5);
    Click(measuring, 6, 5);
    measuring.Clear();
    EXPECT_TRUE(measuring.all().empty());
    EXPECT_EQ(measuring.open(), nullptr);
    EXPECT_TRUE(ReadMeasurements(file).value().empty());
    measuring.Clear();  // nothing more to take away
    measuring.TakeBack();
    ASSERT_EQ(measuring.all().size(), 2u);
    EXPECT_TRUE(measuring.all()[0].closed);
    EXPECT_EQ(ReadMeasurements(file).value().size(), 2u);
    measuring.TakeBack();  // as before: the last click
    EXPECT_EQ(measuring.all()[1].corners.size(), 1u);
    measuring.Clear();
    Click(measuring, 0, 0);
    measuring.TakeBack();
    measuring.TakeBack();
    EXPECT_TRUE(measuring.all().empty());
}

TEST(Measuring, EverythingIsKeptInTheFile) {
    const TempFolder folder;
    const std::string file = MeasurementsFile(folder.path());
    EXPECT_EQ(file, folder.path() + "/measurements.json");
    {
        Measuring measuring;
        measuring.Open(file);
        EXPECT_FALSE(std::filesystem::exists(file));  // nothing to keep yet
        ClickSquare(measuring);
        Click(measuring, 5, 5);  // a point alone is not kept
        EXPECT_EQ(measuring.trouble(), "");
    }
    Measuring measuring;
    measuring.Open(file);
    ASSERT_EQ(measuring.all().size(), 1u);
    EXPECT_TRUE(measuring.all()[0].closed);
    EXPECT_GT(measuring.changes(), 0u);
    Click(measuring, 0, 0);
    Click(measuring, 1, 0);
    EXPECT_EQ(ReadMeasurements(file).value().size(), 2u);
    measuring.Clear();
    EXPECT_TRUE(ReadMeasurements(file).value().empty());
}

TEST(Measuring, AFileThatCannotBeReadIsLeftAlone) {
    const TempFolder folder;
    const std::string file = folder.path() + "/measurements.json";
    std::ofstream(file) << "by somebody else";
    Measuring measuring;
    measuring.Open(file);
    EXPECT_TRUE(measuring.trouble().starts_with(file)) << measuring.trouble();
    EXPECT_NE(measuring.trouble().find("nothing will be saved"), std::string::npos);
    ClickSquare(measuring);
    EXPECT_EQ(measuring.all().size(), 1u);
    std::stringstream text;
    text << std::ifstream(file).rdbuf();
    EXPECT_EQ(text.str(), "by somebody else");
    EXPECT_NE(measuring.trouble(), "");
}

TEST(Measuring, WhatCannotBeWrittenIsSaid) {
    const TempFolder folder;
    Measuring measuring;
    measuring.Open(folder.path() + "/absent/measurements.json");
    ClickSquare(measuring);
    EXPECT_NE(measuring.trouble().find("absent"), std::string::npos) << measuring.trouble();
}

TEST(Measuring, AFilesMeasurementsLieBesideIt) {
    const TempFolder folder;
    const std::string mesh = folder.path() + "/room.ply";
    std::ofstream{mesh};
    EXPECT_EQ(MeasurementsFile(mesh), folder.path() + "/room.measurements.json");
    EXPECT_EQ(MeasurementsFile(folder.path() + "/new"), folder.path() + "/new/measurements.json");
}

}  // namespace
}  // namespace tessera
