#include "viz/system_view.h"

#include <gtest/gtest.h>

namespace tessera {
namespace {

FrameUpdate FrameOf(std::int64_t index) {
    FrameUpdate update;
    update.report.index = index;
    update.report.first = index == 0;
    return update;
}

TEST(SystemView, TheDetectorsRateIsOfTheLastSeconds) {
    ViewerLink link;
    SystemView view;
    EXPECT_FALSE(view.Take(link, 0));
    for (int i = 0; i < 20; ++i) {
        link.labels.Push(LabelUpdate{});
        EXPECT_TRUE(view.Take(link, 0.5 * i));
        EXPECT_DOUBLE_EQ(view.detections_per_s(), i == 0 ? 0 : 2);
    }
    link.labels.Push(LabelUpdate{});
    view.Take(link, 13.5);  // 4 s later only 2 of the 11 earlier intervals count
    EXPECT_DOUBLE_EQ(view.detections_per_s(), 3 / 5.0);
}

TEST(SystemView, ADetectorThatBrokeIsNoAnswer) {
    ViewerLink link;
    SystemView view;
    LabelUpdate stopped;
    stopped.stopped = true;
    link.labels.Push(LabelUpdate{});
    view.Take(link, 0);
    EXPECT_FALSE(view.labels().stopped);
    link.labels.Push(LabelUpdate(stopped));
    view.Take(link, 1);
    EXPECT_TRUE(view.labels().stopped);
    EXPECT_EQ(view.detections_per_s(), 0);
}

TEST(SystemView, ObjectsAreTheNewestAndGoWithTheWorld) {
    ViewerLink link;
    SystemView view;
    link.frames.Push(FrameOf(0));
    link.objects.Push(std::vector<MapObject>(3));
    link.objects.Push(std::vector<MapObject>(2));
    view.Take(link, 0);
    EXPECT_EQ(view.objects().size(), 2u);
    const std::uint64_t taken = view.objects_taken();
    link.frames.Push(FrameOf(1));
    view.Take(link, 1);
    EXPECT_EQ(view.objects().size(), 2u);
    EXPECT_EQ(view.objects_taken(), taken);
    link.frames.Push(FrameOf(0));  // after a reset
    view.Take(link, 2);
    EXPECT_TRUE(view.objects().empty());
    EXPECT_NE(view.objects_taken(), taken);
}

// The camera was lost, and is tracked in another place of the same map.
TEST(SystemView, ANewPartBreaksThePathAndKeepsTheRest) {
    ViewerLink link;
    SystemView view;
    const auto push = [&](FrameUpdate update, double x_m) {
        update.report.track.status = TrackStatus::kGood;
        update.report.track.T_world_camera.translation().x() = x_m;
        update.T_world_camera_truth = update.report.track.T_world_camera;
        link.frames.Push(std::move(update));
        view.Take(link, 0);
    };
    push(FrameOf(0), 0);
    push(FrameOf(1), 0.1);
    link.objects.Push(std::vector<MapObject>(2));
    view.Take(link, 0);
    const std::uint64_t identity = view.path_identity();
    FrameUpdate part = FrameOf(2);
    part.report.first = part.report.begins_part = true;
    push(std::move(part), 1000);
    push(FrameOf(3), 1000.1);
    EXPECT_EQ(view.path_identity(), identity);
    EXPECT_EQ(view.objects().size(), 2u);
    ASSERT_EQ(view.path().size(), 4u);
    EXPECT_EQ(view.truth().size(), 4u);
    EXPECT_TRUE(view.path()[1].follows);
    EXPECT_FALSE(view.path()[2].follows);
    EXPECT_TRUE(view.path()[3].follows);
    EXPECT_NEAR(view.place()->x(), 1000.1, 1e-3);
}

}  // namespace
}  // namespace tessera
