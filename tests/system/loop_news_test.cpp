// What a thread that closes loops tells of, and what it leaves alone.
#include "optimize/room_walk.h"
#include "system/loop_thread.h"

namespace tessera {
namespace {

using testing_support::RoomSettings;
using testing_support::RoomWalk;

// Where the thread works, and tracked frames for it.
struct Place {
    FieldSettings field = RoomSettings();
    Wake mapping, tracking;
    Pool<Frame> frames;
    Pool<TrackedFrame> tracked_frames;
    Notices notices{mapping};

    LoopThread::Surroundings around() {
        return {frames, tracked_frames, mapping, tracking, notices};
    }
    // Waits until the thread has begun with it: no frame is thinned out.
    void Offer(const Frame& frame, LoopThread& thread) {
        auto tracked = std::make_unique<TrackedFrame>();
        PrepareFrame(frame, field.preparation, tracked->prepared);
        tracked->report.stamp_s = frame.stamp_s;
        tracked->report.fused = true;
        tracked->report.track.T_world_camera = *frame.T_world_camera;
        tracked->report.track.status = TrackStatus::kGood;
        tracked->report.track.inlier_fraction = 1;
        tracked->view.T_world_camera = *frame.T_world_camera;
        thread.Offer(std::move(tracked), std::make_unique<Frame>(frame), {});
        mapping.Wait([&] { return thread.waiting() == 0; });
    }
};

// A file that is begun in the middle of a run and cut off soon after has the frames of its
// keyframes.
TEST(LoopNews, TheFirstHasAllThatWasBeforeItWasAskedFor) {
    Place place;
    LoopConfig config;
    config.average_frames = false;
    LoopThread thread({config, place.field, 5000, std::nullopt, false, std::nullopt},
                      place.around());
    const std::vector<Frame> walk = RoomWalk(0, 21, 1);
    for (std::size_t i = 0; i + 1 < walk.size(); ++i) place.Offer(walk[i], thread);
    thread.BeginNews();
    place.Offer(walk.back(), thread);
    LoopThread::Update update;
    place.mapping.Wait([&] { return thread.TryTake(update); });
    EXPECT_GE(update.news.frames.size(), 20u);
    EXPECT_GE(update.news.passages.size(), 20u);
}

// A scan that was cut off between a loop and its map. A run that only localises keeps that map.
TEST(LoopNews, AMapThatIsOnlyUsedIsNotCorrected) {
    const std::vector<Frame> walk = RoomWalk(0, 4, 10);
    testing_support::Walker walker(LoopConfig{});
    for (const Frame& frame : walk)
        walker.Go(frame, Eigen::Isometry3d(Eigen::Translation3d(0, 0, 0.4)));
    const ScanGraph& graph = walker.closer.graph();
    const std::span<const Keyframe> keyframes = graph.keyframes().all();
    LoopCloser::Memory memory;
    memory.graph = {{keyframes.begin(), keyframes.end()}, graph.edges(), graph.passages(), 1, true};
    memory.frames = walker.closer.store().frames();
    memory.next_ordinal = walker.closer.store().next_ordinal();
    ASSERT_GT(memory.graph.keyframes.size(), 1u);
    memory.graph.keyframes.back().T_world_camera.translation().x() += 1;
    for (const bool only_answers : {false, true}) {
        Place place;
        LoopThread::Settings settings{LoopConfig{}, place.field, 5000, std::nullopt, false, memory};
        settings.only_answers = only_answers;
        LoopThread thread(std::move(settings), place.around());
        // When the second is begun, the thread has done what follows the first.
        for (int i = 0; i < 2; ++i) thread.OfferDetections(-1, {}, {}, {});
        place.mapping.Wait([&] { return thread.waiting() == 0; });
        EXPECT_EQ(thread.wants_map(), !only_answers);
    }
}

}  // namespace
}  // namespace tessera
