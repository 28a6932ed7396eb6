#include "viz/measurement.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <fstream>
#include <numbers>

#include "support/temp_folder.h"

namespace tessera {
namespace {

// Turned and moved, so that nothing lies along an axis.
Eigen::Vector3d Placed(double x, double y, double z) {
    const Eigen::Isometry3d T = Eigen::Translation3d(3, -2, 7) *
                                Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, -1).normalized());
    return T * Eigen::Vector3d(x, y, z);
}

Measurement Line(std::vector<Eigen::Vector3d> corners) {
    Measurement m;
    m.corners = std::move(corners);
    return m;
}

Measurement Polygon(std::vector<Eigen::Vector3d> corners) {
    Measurement m = Line(std::move(corners));
    m.closed = true;
    return m;
}

TEST(Measurement, ALineHasLengthsAndAngles) {
    const Measurement m = Line({Placed(0, 0, 0), Placed(2, 0, 0), Placed(2, 1.5, 0)});
    EXPECT_NEAR(Length_m(m), 3.5, 1e-12);
    ASSERT_EQ(EdgesOf(m).size(), 2u);
    EXPECT_NEAR(EdgesOf(m)[1].length_m(), 1.5, 1e-12);
    EXPECT_FALSE(Angle_deg(m, 0));
    EXPECT_NEAR(Angle_deg(m, 1).value(), 90, 1e-9);
    EXPECT_FALSE(Angle_deg(m, 2));
    EXPECT_FALSE(Angle_deg(m, 3));
    EXPECT_EQ(Area_m2(m), 0);
    EXPECT_EQ(Unevenness_m(m), 0);
    EXPECT_EQ(Volume_m3(m), 0);
}

TEST(Measurement, AnglesFromSharpToStraight) {
    for (const double angle : {0.5, 30.0, 90.0, 150.0, 180.0}) {
        const double rad = angle * std::numbers::pi / 180;
        const Measurement m = Line({Placed(3, 0, 1), Placed(0, 0, 1),
                                    Placed(0.2 * std::cos(rad), 0.2 * std::sin(rad), 1)});
        EXPECT_NEAR(Angle_deg(m, 1).value(), angle, 1e-5);
    }
    EXPECT_FALSE(Angle_deg(Line({Placed(0, 0, 0), Placed(0, 0, 0), Placed(1, 0, 0)}), 1));
}

// An L: 3 x 2 without 1 x 1, so one corner points inwards.
TEST(Measurement, AnAreaNeedNotBeConvex) {
    Measurement m = Polygon({Placed(0, 0, 0), Placed(3, 0, 0), Placed(3, 1, 0), Placed(2, 1, 0),
                             Placed(2, 2, 0), Placed(0, 2, 0)});
    EXPECT_NEAR(Area_m2(m), 5, 1e-12);
    EXPECT_NEAR(Length_m(m), 10, 1e-12);
    EXPECT_EQ(EdgesOf(m).size(), 6u);
    EXPECT_NEAR(Unevenness_m(m), 0, 1e-12);
    EXPECT_NEAR(Angle_deg(m, 0).value(), 90, 1e-9);
    std::reverse(m.corners.begin(), m.corners.end());
    EXPECT_NEAR(Area_m2(m), 5, 1e-12);
}

TEST(Measurement, AnAreaIsThatOfItsMeanPlane) {
    constexpr double kUp = 0.01;  // corners above and below in turn
    const Measurement m =
        Polygon({Placed(0, 0, kUp), Placed(2, 0, -kUp), Placed(2, 2, kUp), Placed(0, 2, -kUp)});
    EXPECT_NEAR(Area_m2(m), 4, 1e-12);
    EXPECT_NEAR(Unevenness_m(m), kUp, 1e-12);
}

TEST(Measurement, ABodyHasTheVolumeOfAPrism) {
    Measurement m = Polygon({Placed(0, 0, 0), Placed(4, 0, 0), Placed(0, 3, 0)});
    for (const double height : {2.5, -2.5}) {
        m.top = Placed(17, -5, height);  // not over the area
        EXPECT_NEAR(Height_m(m), 2.5, 1e-12);
        EXPECT_NEAR(Volume_m3(m), 15, 1e-11);
        ASSERT_EQ(TopCorners(m).size(), 3u);
        EXPECT_LT((TopCorners(m)[1] - Placed(4, 0, height)).norm(), 1e-12);
    }
    m.top.reset();
    EXPECT_TRUE(TopCorners(m).empty());
}

TEST(Measurement, TheFileKeepsThePoints) {
    std::vector<Measurement> all{Line({Placed(0, 0, 0), Placed(1, 2, 3)}),
                                 Polygon({Placed(0, 0, 0), Placed(4, 0, 0), Placed(0, 3, 0)})};
    all[1].top = Placed(0, 0, 1);
    const TempFolder folder;
    const std::string path = folder.path() + "/measurements.json";
    std::ofstream(path) << MeasurementsJson(all);
    const Result<std::vector<Measurement>> read = ReadMeasurements(path);
    ASSERT_TRUE(read.ok()) << read.message();
    ASSERT_EQ(read.value().size(), 2u);
    for (std::size_t i = 0; i < 2; ++i) {
        EXPECT_EQ(read.value()[i].corners, all[i].corners);
        EXPECT_EQ(read.value()[i].closed, all[i].closed);
        EXPECT_EQ(read.value()[i].top, all[i].top);
    }
    EXPECT_NE(MeasurementsJson(all).find("\"volume_m3\": 6.0"), std::string::npos)
        << MeasurementsJson(all);
}

TEST(Measurement, BadFilesAreNamed) {
    const TempFolder folder;
    const std::string path = folder.path() + "/bad.json";
    for (const auto& [text, says] :
         {std::pair{"", "measurements"},
          {"[]", "measurements"},
          {"{\"measurements\": 3}", "measurements"},
          {"{\"measurements\": [{}]}", "measurement 0"},
          {"{\"measurements\": [{\"corners\": [[0,0,0]], \"closed\": false}]}", "two corners"},
          {"{\"measurements\": [{\"corners\": [[0,0,0],[1,0,0]], \"closed\": true}]}", "three"},
          {"{\"measurements\": [{\"corners\": [[0,0],[1,0,0]], \"closed\": false}]}", "numbers"},
          {"{\"measurements\": [{\"corners\": [[0,0,0],[1e99,0,0]], \"closed\": false}]}", "far"},
          {"{\"measurements\": [{\"corners\": [[0,0,0],[1,\"\\u001b\",0]], \"closed\": false}]}",
           "measurement 0"},
          {"{\"measurements\": [{\"corners\": [[0,0,0],[1,0,0]], \"closed\": false, "
           "\"top\": [0,0,0]}]}",
           "no top"}}) {
        std::ofstream(path) << text;
        const Result<std::vector<Measurement>> read = ReadMeasurements(path);
        ASSERT_FALSE(read.ok()) << text;
        EXPECT_TRUE(read.message().starts_with(path)) << read.message();
        EXPECT_NE(read.message().find(says), std::string::npos) << text << ": " << read.message();
    }
    EXPECT_FALSE(ReadMeasurements(folder.path() + "/none.json").ok());
}

}  // namespace
}  // namespace tessera
