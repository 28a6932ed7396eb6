// What tracking, mapping and labelling hand to each other in a live run.
#include "system/live_mapping.h"

#include <chrono>
#include <future>
#include <thread>

#include "system/engine_fixture.h"
#include "system/live_tracking.h"
#include "system/room_frames.h"

namespace tessera {
namespace {

// Tells of each frame that it looks at.
class TellingDetector : public Detector {
  public:
    explicit TellingDetector(std::vector<std::promise<double>>& looked, double ms = 0)
        : looked_(looked), ms_(ms) {}
    Result<std::vector<Detection>> Detect(const Frame& frame) override {
        if (calls_ < looked_.size()) looked_[calls_++].set_value(frame.stamp_s);
        WaitFor(ms_);
        return std::vector<Detection>{};
    }
    const std::vector<std::string>& class_names() const override { return names_; }

  private:
    std::vector<std::promise<double>>& looked_;
    double ms_;  // how long it takes
    std::size_t calls_ = 0;
    std::vector<std::string> names_{"cup"};
};

// Fails when it is told to.
class FailingDetector : public Detector {
  public:
    FailingDetector(std::promise<void>& begun, std::promise<void>& fail)
        : begun_(begun), fail_(fail.get_future()) {}
    Result<std::vector<Detection>> Detect(const Frame&) override {
        begun_.set_value();
        fail_.wait();
        return Status::Error("the network fell over");
    }
    const std::vector<std::string>& class_names() const override { return names_; }

  private:
    std::promise<void>& begun_;
    std::future<void> fail_;
    std::vector<std::string> names_{"cup"};
};

Labelling Cups(std::unique_ptr<Detector> detector) {
    LabelConfig cups;
    cups.classes = "cup";
    LabelClasses classes = LabelClasses::Make(cups, detector->class_names()).value();
    return {std::move(detector), std::move(classes)};
}

class LiveMappingTest : public EngineTest {
  protected:
    LiveMappingTest() { config.loops.enabled = false; }
    void TearDown() override { engine.reset(); }  // the link must outlive it

    MappingTask Task(double stamp_s, bool first, bool fused) const {
        MappingTask task;
        task.frame = std::make_unique<Frame>(RoomFrame(0));
        task.frame->stamp_s = stamp_s;
        task.tracked = std::make_unique<TrackedFrame>();
        PrepareFrame(*task.frame, config.pipeline.frame, task.tracked->prepared);
        task.tracked->report.stamp_s = stamp_s;
        task.tracked->report.first = first;
        task.tracked->report.track.status = TrackStatus::kGood;
        task.tracked->to_fuse = fused;
        return task;
    }
    // Stamps of the frames whose detections were reported since the last call.
    std::vector<double> Labelled() {
        std::vector<double> stamps_s;
        for (FrameOutcome outcome; links.outcomes.TryPop(outcome);)
            if (outcome.labels) stamps_s.push_back(outcome.labels->stamp_s);
        return stamps_s;
    }

    ViewerLink link;
    Wake owner;
    Notices notices{owner};
    LiveLinks links{false, notices, owner};
    const SourceInfo source = Source().info();
};

// It waits for it.
TEST_F(LiveMappingTest, TrackingGetsAnAnswerToAFirstFrameThatIsNotFused) {
    LiveMapping mapping(config, source, nullptr, nullptr, links);
    ASSERT_TRUE(mapping.Start({}, {}, {}).ok());
    mapping.Send(Task(1, true, false));
    mapping.Send(Task(2, false, false));
    mapping.Finish();
    ASSERT_EQ(links.map_updates.size(), 1u);
    MapUpdate answer;
    links.map_updates.TryPop(answer);
    EXPECT_TRUE(answer.first);
}

// Also if a corrected map, which lacks the frame, comes just before its answer. With a device
// nobody but this test sends updates.
TEST_F(LiveMappingTest, TheSecondFrameOfAPartIsTrackedInTheMapOfTheFirst) {
    CpuBackend device;
    LiveMapping mapping(config, source, &device, nullptr, links);
    mapping.life().stage().KeepDeltas();
    ASSERT_TRUE(mapping.Start({}, {}, {}).ok());
    LiveTracking tracking({config, source.camera, nullptr, nullptr, std::nullopt}, {}, links,
                          mapping);
    FrameOutcome outcome;
    const auto push = [&](int i) {
        tracking.Push({std::make_unique<Frame>(RoomFrame(i)), 0, LiveClock::now()});
    };
    const auto next = [&] { owner.Wait([&] { return links.outcomes.TryPop(outcome); }); };
    push(0);
    next();
    ASSERT_TRUE(outcome.report.first);
    push(1);
    MapUpdate corrected, answer{std::make_unique<MapDelta>(), 0, nullptr};
    corrected.field =
        std::make_unique<BlockMap>(config.pipeline.map, config.pipeline.trackers.layers());
    ASSERT_TRUE(links.map_updates.TryPush(std::move(corrected)));
    while (!links.map_updates.empty()) std::this_thread::yield();
    answer.first = true;
    mapping.life().stage().CollectDelta(*answer.delta);
    ASSERT_TRUE(links.map_updates.TryPush(std::move(answer)));
    next();
    EXPECT_EQ(outcome.report.index, 1);
    EXPECT_TRUE(outcome.report.tracked()) << outcome.report.track.reason;
    tracking.Finish();
}

// Without another frame. The window takes more than its queue has room for.
TEST_F(LiveMappingTest, WhilePausedTheWindowGetsTheRestOfTheMesh) {
    config.live.mesh_blocks = 5;
    link.paused.store(true);
    LiveLinks shown(false, notices, owner, &link);
    LiveMapping mapping(config, source, nullptr, &link, shown);
    ASSERT_TRUE(mapping.Start({}, {}, {}).ok());
    mapping.Send(Task(1, true, true));
    const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(1);
    std::size_t updates = 0;
    const std::size_t wanted = 3 * link.meshes.capacity();
    while (updates < wanted && std::chrono::steady_clock::now() < end) {
        MeshUpdate update;
        if (link.meshes.TryPop(update)) ++updates;
        link.system.Notify();
        std::this_thread::yield();
    }
    EXPECT_EQ(updates, wanted);
    mapping.Finish();
}

// What mapping still sends of the old world is not the new world's map. Tracking is slow, so that
// it comes while the first frame is tracked.
TEST_F(LiveMappingTest, NoFrameAfterAResetIsLost) {
    viewer = &link;
    config.live.playback_speed = 0.5;
    config.live.queue_frames = 100;  // no frame is dropped
    config.live.extra_tracking_ms = 100;
    Make(true, {.speed = 0.3});
    while (Reports().size() < 4) ASSERT_TRUE(Next());
    Ask(Command::kReset);
    while (Count(Kind::kReset) == 0) ASSERT_TRUE(Next());
    outcomes.clear();
    while (Reports().size() < 6) ASSERT_TRUE(Next());
    Ask(Command::kStop);
    TakeAll();
    EXPECT_TRUE(Reports().front()->first);
    for (const FrameReport* report : Reports())
        EXPECT_TRUE(report->tracked()) << report->index << " " << report->track.reason;
}

TEST_F(LiveMappingTest, LabelsGoOnAfterTheClockWasSetBack) {
    std::vector<std::promise<double>> looked(2);
    LiveMapping mapping(config, source, nullptr, nullptr, links);
    ASSERT_TRUE(mapping.Start(Cups(std::make_unique<TellingDetector>(looked)), {}, {}).ok());
    for (const double stamp_s : {100.0, 5.0}) {
        mapping.Send(Task(stamp_s, stamp_s == 100, true));
        std::future<double> seen = looked[stamp_s == 100 ? 0 : 1].get_future();
        ASSERT_EQ(seen.wait_for(std::chrono::minutes(1)), std::future_status::ready) << stamp_s;
        EXPECT_EQ(seen.get(), stamp_s);
    }
    mapping.Finish();
}

// Each answer is reported when it is taken, also one that comes after the last frame. With a device
// the test says when answers are taken.
TEST_F(LiveMappingTest, EveryAnswerOfTheDetectorIsReported) {
    std::vector<std::promise<double>> looked(3);
    CpuBackend device;
    LiveMapping mapping(config, source, &device, nullptr, links);
    ASSERT_TRUE(mapping.Start(Cups(std::make_unique<TellingDetector>(looked)), {}, {}).ok());
    const auto send = [&](double stamp_s) {
        mapping.Send(Task(stamp_s, stamp_s == 1, true));
        links.mapping.Wait([&] { return mapping.HasAnswersToTake(); });
    };
    for (const double stamp_s : {1.0, 2.0}) {
        send(stamp_s);
        while (mapping.HasAnswersToTake()) mapping.TakeAnswersHere();
        EXPECT_EQ(Labelled(), std::vector{stamp_s});
    }
    send(3);
    mapping.Finish();
    EXPECT_EQ(Labelled(), std::vector{3.0});
}

// A short recording and a slow detector.
TEST_F(LiveMappingTest, TheDetectionUnderWayAtTheEndIsWaitedFor) {
    std::vector<std::promise<double>> looked(1);
    LiveMapping mapping(config, source, nullptr, nullptr, links);
    ASSERT_TRUE(mapping.Start(Cups(std::make_unique<TellingDetector>(looked, 100)), {}, {}).ok());
    mapping.Send(Task(1, true, true));
    looked[0].get_future().wait();
    mapping.Finish();
    EXPECT_EQ(Labelled(), std::vector{1.0});
}

TEST_F(LiveMappingTest, AFrameThatWaitedWhenTheDetectorFailedOnlyComesBack) {
    std::promise<void> begun, fail;
    Labelling cups = Cups(std::make_unique<FailingDetector>(begun, fail));
    LabellingThread labelling({std::move(cups.detector), std::move(cups.classes), {}, {}}, {},
                              owner);
    const auto offer = [&](std::int64_t index) {
        auto frame = std::make_unique<Frame>();
        frame->index = index;
        return labelling.Offer({std::move(frame), Eigen::Isometry3d::Identity(), {}});
    };
    EXPECT_EQ(offer(0), nullptr);
    begun.get_future().wait();
    EXPECT_EQ(offer(1), nullptr);
    fail.set_value();
    LabellingThread::Answer failure, unseen;
    owner.Wait([&] { return labelling.TryTake(failure); });
    owner.Wait([&] { return labelling.TryTake(unseen); });
    EXPECT_NE(failure.message.find("the network fell over"), std::string::npos) << failure.message;
    EXPECT_EQ(failure.job.frame->index, 0);
    EXPECT_EQ(failure.job.map.world, 0);
    EXPECT_EQ(unseen.message, "");
    EXPECT_EQ(unseen.job.frame->index, 1);
    EXPECT_FALSE(unseen.looked_at);
    EXPECT_TRUE(labelling.stopped());
    EXPECT_NE(offer(2), nullptr);
}

}  // namespace
}  // namespace tessera
