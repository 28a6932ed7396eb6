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

}  // namespace
}  // namespace tessera
