// Loop closure in a live run: the thread corrects a walk that drifts, and relocalises a camera that
// is lost during the run.
#include "system/loop_thread.h"

#include <map>
#include <set>

#include "mapping/map_copier.h"
#include "optimize/drifting_walk.h"

namespace tessera {
namespace {

using testing_support::Bias;
using testing_support::RoomSettings;
using testing_support::RoomWalk;

// Acts as the mapping thread. Its poses drift in the current map.
class LoopThreadTest : public testing::Test {
  protected:
    void Go(const Frame& frame, const Eigen::Isometry3d& T_last_camera,
            std::optional<int> found_at = {}) {
        T_map_camera = Normalised(T_map_camera * T_last_camera);
        auto tracked = tracked_frames.Take();
        PrepareFrame(frame, settings.preparation, tracked->prepared);
        tracked->report = {};
        tracked->found_at = found_at;
        tracked->report.stamp_s = frame.stamp_s;
        tracked->report.fused = true;
        tracked->report.track.T_world_camera = tracked->view.T_world_camera = T_map_camera;
        tracked->report.track.status = TrackStatus::kGood;
        tracked->report.track.inlier_fraction = 1;
        auto copy = frames.Take();
        *copy = frame;
        if (map) integrator.Integrate(tracked->prepared, tracked->view, *map);
        thread.Offer(std::move(tracked), std::move(copy), {0, corrections});
        // The thread may be slow. This test needs all frames, so it waits while too many are
        // queued.
        mapping.Wait([&] { return thread.waiting() < 6; });
        TakeCorrections();
        GiveMap();
    }
    // As it is, or with no memory for a copy none.
    void GiveMap() {
        if (!answers || !thread.wants_map()) return;
        std::unique_ptr<BlockMap> copy;
        if (map) copy = copier.Copy(*map, integrator.revision(), map->size());
        ++given;
        thread.GiveMap(std::move(copy), {0, given == 1 ? first_given : corrections});
    }
    // Returns where odometry ends that is off by this share of `Bias`.
    Eigen::Isometry3d Drift(const std::vector<Frame>& walk, double share) {
        Eigen::Isometry3d T_drifted = Eigen::Isometry3d::Identity();
        for (std::size_t i = 0; i < walk.size(); ++i) {
            const Eigen::Isometry3d step = i == 0 ? T_drifted
                                                  : walk[i - 1].T_world_camera->inverse() *
                                                        *walk[i].T_world_camera * Bias(share);
            T_drifted = T_drifted * step;
            Go(walk[i], step);
        }
        return T_drifted;
    }
    void TakeCorrections() {
        LoopThread::Update update;
        while (thread.TryTake(update)) {
            ASSERT_EQ(update.world, 0);
            Keep(update.news);
            if (!update.correction) continue;
            blocks = update.correction->map->count();
            if (map) map = std::move(update.correction->map);
            if (update.field) {  // null for the last
                ASSERT_EQ(update.field->count(), blocks);
            }
            T_map_camera = Normalised(update.correction->T_new_old * T_map_camera);
            ++corrections;
        }
    }
    // Stores the news as a scan file does.
    void Keep(const LoopChanges& news) {
        passages.insert(passages.end(), news.passages.begin(), news.passages.end());
        for (const auto& [id, pose] : news.poses) poses[id] = pose;
        for (const StoredFrame& frame : news.frames) stored[frame.ordinal] = frame;
        for (const Keyframe& keyframe : news.keyframes) keyframes.insert(keyframe.id);
        if (news.progress) progress = *news.progress;
    }

    FieldSettings settings = RoomSettings();
    Wake mapping, tracking;
    Pool<Frame> frames;
    Pool<TrackedFrame> tracked_frames;
    Notices notices{mapping};
    LoopThread thread{{LoopConfig{}, settings, 5000, std::nullopt, true, std::nullopt},
                      {frames, tracked_frames, mapping, tracking, notices}};
    std::vector<PathPose> passages;
    std::map<int, KeyframePoses> poses;
    std::map<std::int64_t, StoredFrame> stored;
    std::set<int> keyframes;
    LoopProgress progress;
    Eigen::Isometry3d T_map_camera = Eigen::Isometry3d::Identity();
    int corrections = 0;
    // Null: the thread gets no map.
    std::unique_ptr<BlockMap> map;
    Integrator integrator{settings.fusion, settings.camera};
    MapCopier copier;
    bool answers = true;
    int given = 0, first_given = 0;  // how often, and which version the first claims to be
    std::int64_t blocks = 0;         // of the last corrected map
};

TEST_F(LoopThreadTest, CorrectsAWalkThatDrifts) {
    if (!PoseGraphAvailable()) GTEST_SKIP() << "this build has no Ceres: install libceres-dev";
    const std::vector<Frame> walk = RoomWalk(0, 120, 6);
    const Eigen::Isometry3d T_drifted = Drift(walk, 1);
    thread.Finish(nullptr, {});
    std::string news;
    while (const auto notice = notices.Take()) news += *notice + "\n";
    TakeCorrections();
    EXPECT_GE(corrections, 1);
    const std::vector<StampedPose> path = thread.Path();
    ASSERT_EQ(path.size(), walk.size());
    const Eigen::Vector3d truth = walk.back().T_world_camera->translation();
    const double before_m = (T_drifted.translation() - truth).norm();
    EXPECT_GT(before_m, 0.07);
    EXPECT_LT((path.back().T_world_camera.translation() - truth).norm(), before_m / 5);
    // The news must describe the whole path, including moved keyframes.
    ASSERT_EQ(passages.size(), path.size());
    EXPECT_EQ(poses.size(), keyframes.size());
    for (std::size_t i = 0; i < path.size(); ++i) {
        const Eigen::Isometry3d T_world_camera = Normalised(
            poses.at(passages[i].keyframe).T_world_camera * passages[i].T_keyframe_camera);
        EXPECT_EQ(T_world_camera.matrix(), path[i].T_world_camera.matrix()) << i;
    }
    // Every frame is stored, alone or in an average.
    float weight = 0;
    for (const auto& [ordinal, frame] : stored) weight += frame.view.weight;
    EXPECT_FLOAT_EQ(weight, static_cast<float>(walk.size()));
    EXPECT_GE(progress.loops, 1);
    EXPECT_EQ(progress.next_ordinal, static_cast<std::int64_t>(stored.size()));
    EXPECT_NE(news.find("loop closed"), std::string::npos) << news;
    EXPECT_NE(news.find("optimising the corrected path once more"), std::string::npos) << news;
}

// At the end the map in use follows the path, here an empty one, unless a correction came between.
TEST_F(LoopThreadTest, MovesTheMapOfItsVersion) {
    if (!PoseGraphAvailable()) GTEST_SKIP() << "this build has no Ceres: install libceres-dev";
    Drift(RoomWalk(0, 120, 6), 0.3);  // by less than makes a correction before the end
    ASSERT_EQ(corrections, 0);
    const BlockMap empty(settings.map);
    thread.Finish(&empty, {0, 0});
    TakeCorrections();
    EXPECT_EQ(corrections, 1);
    EXPECT_EQ(blocks, 0);
}

TEST_F(LoopThreadTest, DoesNotMoveTheMapOfAnotherVersion) {
    if (!PoseGraphAvailable()) GTEST_SKIP() << "this build has no Ceres: install libceres-dev";
    Drift(RoomWalk(0, 120, 6), 0.3);
    const BlockMap empty(settings.map);
    thread.Finish(&empty, {0, 1});
    TakeCorrections();
    EXPECT_EQ(corrections, 1);
    EXPECT_GT(blocks, 1000);
}

// A block that no frame has seen is in a map that was moved only.
constexpr BlockCoord kUnseen{500, 0, 0};
std::unique_ptr<BlockMap> MapWithUnseen(const BlockMap::Config& config) {
    auto map = std::make_unique<BlockMap>(config);
    std::fill_n(map->field(map->Allocate(kUnseen)), kBlockVoxels, FieldWord{0});
    return map;
}

TEST_F(LoopThreadTest, MovesTheMapInUseDuringTheRun) {
    if (!PoseGraphAvailable()) GTEST_SKIP() << "this build has no Ceres: install libceres-dev";
    map = MapWithUnseen(settings.map);
    first_given = 7;  // of another version: the thread asks again
    const std::vector<Frame> walk = RoomWalk(0, 120, 6);
    Drift(walk, 1);
    while (corrections == 0) {
        mapping.Wait([&] { return thread.has_update() || thread.wants_map(); });
        TakeCorrections();
        GiveMap();
    }
    EXPECT_GE(corrections, 1);
    EXPECT_GE(given, 2);
    EXPECT_NE(map->Find(kUnseen), kUnknownBlock);
    EXPECT_GT(blocks, 1000);
}

// A correction that is under way when the last frame came is not continued: the map in use must
// stay the one that is moved at the end. Each job would move a fifth of it.
TEST_F(LoopThreadTest, SettledItMovesTheMapInUse) {
    if (!PoseGraphAvailable()) GTEST_SKIP() << "this build has no Ceres: install libceres-dev";
    map = MapWithUnseen(settings.map);
    answers = false;
    Drift(RoomWalk(0, 120, 6), 1);
    mapping.Wait([&] { return thread.wants_map(); });
    answers = true;
    GiveMap();
    thread.Settle();
    for (int i = 0; i < 50; ++i) thread.OfferDetections(0, {}, {}, {0, 0});
    mapping.Wait([&] { return thread.waiting() == 0; });
    TakeCorrections();
    EXPECT_EQ(corrections, 0);
    thread.Finish(map.get(), {0, 0});
    TakeCorrections();
    EXPECT_EQ(corrections, 1);
    EXPECT_NE(map->Find(kUnseen), kUnknownBlock);
}

// With eight frames whole and the rest thinned, the thread may be late for 60 frames, two seconds.
TEST(LoopThreadQueue, KeepsFewerFramesTheMoreWait) {
    int covered = 0;
    for (int waiting = 0; LoopThread::KeptOneIn(waiting) > 0; ++waiting)
        covered += LoopThread::KeptOneIn(waiting);
    EXPECT_EQ(LoopThread::KeptOneIn(7), 1);
    EXPECT_EQ(LoopThread::KeptOneIn(8), 2);
    EXPECT_EQ(LoopThread::KeptOneIn(15), 16);
    EXPECT_EQ(LoopThread::KeptOneIn(16), 0);  // no more than sixteen keep their images
    EXPECT_GE(covered, 60);
}

// The second frame is no keyframe by itself.
TEST_F(LoopThreadTest, AFrameTrackedWhereTheCameraWasFoundIsAKeyframe) {
    const std::vector<Frame> walk = RoomWalk(0, 3, 1);
    for (std::size_t i = 0; i < walk.size(); ++i)
        Go(walk[i], Eigen::Isometry3d::Identity(), i == 1 ? std::optional(0) : std::nullopt);
    thread.Finish(nullptr, {});
    TakeCorrections();
    EXPECT_EQ(poses.size(), 2u);
}

TEST_F(LoopThreadTest, AResetForgetsAllAndAnOldQuestionHasNoAnswer) {
    const std::vector<Frame> walk = RoomWalk(0, 4, 6);  // the first is a keyframe
    for (std::size_t i = 0; i < walk.size(); ++i)
        Go(walk[i], i == 0 ? Eigen::Isometry3d::Identity()
                           : walk[i - 1].T_world_camera->inverse() * *walk[i].T_world_camera);
    mapping.Wait([&] { return thread.waiting() == 0; });
    const auto ask = [&](MapVersion version) {
        auto prepared = std::make_unique<PreparedFrame>();
        PrepareFrame(walk[0], settings.preparation, *prepared);
        EXPECT_TRUE(thread.Ask({version, 1.5, std::move(prepared)}));
        LoopThread::Answer answer;
        tracking.Wait([&] { return thread.TryTake(answer); });
        return answer;
    };
    const LoopThread::Answer here = ask({0, 0});
    ASSERT_TRUE(here.found.has_value());
    EXPECT_FALSE(here.obsolete);
    EXPECT_LT(
        (here.found->T_map_camera.translation() - walk[0].T_world_camera->translation()).norm(),
        0.02);
    EXPECT_EQ(here.stamp_s, 1.5);
    thread.Reset({1, 0});
    mapping.Wait([&] { return thread.waiting() == 0; });
    for (const MapVersion other : {MapVersion{0, 0}, {2, 0}}) {  // of before, and of a later reset
        const LoopThread::Answer none = ask(other);
        EXPECT_FALSE(none.found.has_value()) << other.world;
        EXPECT_TRUE(none.obsolete) << other.world;
    }
    const LoopThread::Answer nowhere = ask({1, 0});  // no keyframe exists after the reset
    EXPECT_FALSE(nowhere.found.has_value());
    EXPECT_FALSE(nowhere.obsolete);
    thread.Finish(nullptr, {});
    EXPECT_TRUE(thread.Path().empty());
}

}  // namespace
}  // namespace tessera
