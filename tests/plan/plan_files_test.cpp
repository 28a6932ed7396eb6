#include "plan/plan_files.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "box_world.h"
#include "plan/plan_objects.h"

namespace tessera {
namespace {

FloorPlan SmallPlan() {
    Result<FloorPlan> plan = MakeFloorPlan(TwoRooms(), UprightPath(), {});
    EXPECT_TRUE(plan.ok());
    MapObject object;
    object.id = 3;
    object.class_name = "chair <&\"\n\xc3\xa4";
    object.oriented_size = Eigen::Vector3d(0.5, 0.4, 0.9);
    object.T_world_oriented.translation() = Eigen::Vector3d(1, 1, 0.45);
    object.T_world_oriented.linear() =
        Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    AddObjects({object}, plan.value());
    return plan.value();
}

TEST(PlanObjects, DrawTheirBoxFromAbove) {
    const FloorPlan plan = SmallPlan();
    ASSERT_EQ(plan.objects.size(), 1U);
    EXPECT_EQ(plan.objects[0].outline.size(), 4U);
    EXPECT_NEAR(SignedArea(plan.objects[0].outline), 0.5 * 0.4, 1e-6);
    EXPECT_NEAR(plan.objects[0].high_m, 0.9, 0.01);
    const Eigen::Isometry3d T = plan.T_plan_world * Eigen::Translation3d(1, 1, 0.45) *
                                Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitZ());
    const Eigen::Vector2d corner = (T * Eigen::Vector3d(0.25, 0.2, 0)).head<2>();
    EXPECT_TRUE(std::ranges::any_of(plan.objects[0].outline, [&](const Eigen::Vector2d& p) {
        return (p - corner).norm() < 1e-3;
    }));
}

TEST(PlanJson, HoldsWhatWasMeasured) {
    const FloorPlan plan = SmallPlan();
    const nlohmann::json json = nlohmann::json::parse(PlanJson(plan));
    ASSERT_EQ(json["rooms"].size(), 2U);
    EXPECT_NEAR(json["rooms"][0]["area"].get<double>(), plan.rooms[0].area_m2, 1e-4);
    EXPECT_EQ(json["rooms"][0]["polygon"].size(), 4U);
    EXPECT_EQ(json["walls"].size(), plan.walls.size());
    EXPECT_NEAR(json["openings"][0]["width"].get<double>(), 0.9, 0.01);
    EXPECT_NEAR(json["T_plan_world"][2][3].get<double>(), plan.T_plan_world(2, 3), 1e-9);
}

// Pairs of a group code and a value; each entity on a layer that the table names.
TEST(PlanDxf, IsMadeOfPairsOnKnownLayers) {
    std::istringstream lines(PlanDxf(SmallPlan()));
    std::string code, value, last;
    std::set<std::string> layers, used;
    while (std::getline(lines, code)) {
        ASSERT_TRUE(std::getline(lines, value)) << code;
        std::size_t end = 0;
        const int number = std::stoi(code, &end);
        EXPECT_EQ(end, code.size());
        for (const char c : value) EXPECT_TRUE(c >= 32 && c < 127) << value;
        if (number == 2 && last == "LAYER") layers.insert(value);
        if (number == 8) used.insert(value);
        if (number == 0) last = value;
    }
    EXPECT_EQ(last, "EOF");
    EXPECT_EQ(used, (std::set<std::string>{"WALLS", "OPENINGS", "ROOMS", "OBJECTS", "DIMENSIONS",
                                           "TEXT"}));
    for (const std::string& layer : used) EXPECT_TRUE(layers.contains(layer)) << layer;
}

TEST(PlanSvg, EscapesNamesAndNamesTheAreas) {
    const std::string svg = PlanSvg(SmallPlan(), "a <b> & c");
    EXPECT_NE(svg.find("a &lt;b&gt; &amp; c"), std::string::npos);
    EXPECT_EQ(svg.find("chair <"), std::string::npos);
    EXPECT_NE(svg.find("12.0"), std::string::npos);
    EXPECT_NE(svg.find("1:50"), std::string::npos);
}

TEST(PlanSvg, DrawsAnEmptyPlan) {
    EXPECT_NE(PlanSvg({}, "nothing").find("no closed room"), std::string::npos);
    EXPECT_NE(PlanDxf({}).find("EOF"), std::string::npos);
}

}  // namespace
}  // namespace tessera
