// Loop closure in a live run: a low-priority thread that owns the LoopCloser. Mapping offers it
// fused frames and takes corrected maps from it. Tracking asks it where a lost camera is. Before
// the end of the run a thread waits for it only in Reset, GiveMap and EnableLabels, if the job
// queue is full.
#pragma once

#include <tbb/task_arena.h>

#include <atomic>

#include "core/notices.h"
#include "core/pool.h"
#include "core/worker.h"
#include "system/loop_journal.h"
#include "system/map_version.h"
#include "system/tracking_stage.h"

namespace tessera {

class LoopThread {
  public:
    struct Settings {
        LoopConfig loops;
        FieldSettings field;
        double depth_units_per_m = 5000;
        std::optional<LoopCloser::Labels> labels;
        // Updates carry news for a scan file. If false, only after BeginNews.
        bool saved = false;
        std::optional<LoopCloser::Memory> resumed;  // of an earlier scan that is continued
        LoopCloser::MakePager make_pager = {};
        BlockMap::Layers tracked_layers = BlockMap::Layers::kFieldOnly;  // of Update::field
        bool only_answers = false;  // the map stays, also one that a resumed scan would correct
    };
    // Apply updates in order: `news` refers to the map after all earlier corrections and the one in
    // this update.
    struct Update {
        int world = 0;
        std::optional<LoopCloser::Correction> correction;
        // A copy of what tracking reads of the corrected map.
        std::unique_ptr<BlockMap> field;
        LoopChanges news;
    };
    // A frame of a lost camera, or of one that was just found, and where it is, if known.
    struct Question {
        MapVersion map;
        double stamp_s = 0;
        std::unique_ptr<PreparedFrame> frame;
        // Where the camera was found before: the question is whether it is there.
        std::optional<Eigen::Isometry3d> T_map_expected = {};
    };
    struct Answer {
        MapVersion map;
        double stamp_s = 0;
        std::optional<FoundCamera> found;
        std::string note;    // for the user
        bool check = false;  // whether it was expected somewhere
        // The question was of another map, and nobody looked: ask again.
        bool obsolete = false;
    };

    // Frame pools, the threads to notify, and who tells the user. All outlive the LoopThread.
    struct Surroundings {
        Pool<Frame>& frames;
        Pool<TrackedFrame>& tracked_frames;
        Wake& mapping;
        Wake& tracking;
        Notices& notices;
    };

    LoopThread(Settings settings, Surroundings surroundings);

    // ---- Mapping thread.
    // Call for each tracked frame, after its fusion. If many frames wait, only the pose is kept of
    // some or all (KeptOneIn); if the job queue is full, nothing.
    void Offer(std::unique_ptr<TrackedFrame> tracked, std::unique_ptr<Frame> frame, MapVersion map);
    void OfferDetections(std::int64_t frame_index, std::vector<Detection> detections,
                         const ClassSet& ignored, MapVersion map);
    // While this holds, copy the map in use, some blocks at a time, and give the copy, or null if
    // there is no memory for one. It must hold the frames offered so far, and no others.
    bool wants_map() const { return map_.load() == Asked::kYes; }
    void GiveMap(std::unique_ptr<BlockMap> copy, MapVersion map);
    // Waits if the job queue is full, as do GiveMap and EnableLabels.
    void Reset(MapVersion map);
    // Corrected maps that are begun after the frames so far have labels.
    void EnableLabels(LoopCloser::Labels labels);
    // Any thread. Off: no loop is closed.
    void SetSeeking(bool on) { seeking_.store(on); }
    // Updates carry news from now on. The next update covers everything so far.
    void BeginNews() { saved_.store(true); }
    bool has_update() const { return !updates_.empty(); }
    bool TryTake(Update& update);
    // Call after the last frame, then take the updates. Waits until all jobs are done. No map is
    // corrected from now on before Finish, so that the map in use is known to it.
    void Settle();
    // Call after Settle. Waits until all corrections are done. The remaining results arrive
    // as updates. `whole`: the map of this version, if all of it is in memory; else null.
    void Finish(const BlockMap* whole, MapVersion version) {
        last_map_ = whole;
        last_version_ = version;
        worker_.Finish();
    }
    // After Finish: the final poses of the tracked frames, and the refined calibration.
    std::vector<StampedPose> Path() const { return closer_->Path(); }
    const std::optional<CalibrationReport>& calibration() const { return closer_->calibration(); }
    // After Finish: everything, for another scan file.
    LoopChanges TakeAll() {
        journal_ = LoopJournal();
        return journal_.Take(*closer_);
    }
    std::size_t waiting() const { return worker_.waiting(); }
    // Of the fused frames offered while this many wait whole, one in how many is kept whole: a
    // stretch of the path for which the thread is late is still covered. 0 for none.
    static int KeptOneIn(int waiting) {
        if (waiting >= kWhole) return 0;
        return waiting < kAllWhole ? 1 : 2 << (waiting - kAllWhole) / 2;
    }

    // ---- Tracking thread. One question at a time.
    bool Ask(Question question) { return questions_.TryPush(std::move(question)); }
    bool TryTake(Answer& answer) { return answers_.TryPop(answer); }

  private:
    struct Job {
        enum class Kind { kFrame, kDetections, kMap, kReset, kLabels, kSettle };
        Kind kind = Kind::kFrame;
        MapVersion map;
        double stamp_s = 0;
        bool fused = false;
        Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
        std::optional<int> found_at;            // see TrackedFrame
        std::unique_ptr<TrackedFrame> tracked;  // null, like `frame`: only the pose is used
        std::unique_ptr<Frame> frame;
        std::int64_t frame_index = 0;
        std::vector<Detection> detections;
        ClassSet ignored;  // classes whose detections were dropped
        std::optional<LoopCloser::Labels> labels;
        std::unique_ptr<BlockMap> copy;
    };

    void Begin();
    bool HasIdleWork() const;
    void WorkIdly();
    void Conclude();
    void BeginWorld(int world);
    bool MayCorrect() const {
        return !settings_.only_answers && seeking_.load() && closer_->HasWork() &&
               map_.load() == Asked::kNo && !settled_.load() &&
               updates_.size() < kUpdates - kForCorrections;
    }
    void Do(Job& job);
    void AddFrame(Job& job);
    void Correct();
    bool Reply();
    void Report();
    void ReportProblems();
    void Push(Update update);
    MapVersion version() const { return {world_, static_cast<int>(history_.size())}; }
    void HandOver(LoopCloser::Correction change, bool last = false);

    Settings settings_;
    Surroundings around_;
    // The last places in `updates_`, kForCorrections, are reserved for corrections.
    static constexpr std::size_t kJobs = 4096, kUpdates = 8, kForCorrections = 3;
    // Waiting frames that keep their images, about 6 MB each: all of the first, fewer of the rest.
    static constexpr int kWhole = 16, kAllWhole = 8;
    std::atomic<int> whole_{0};
    int since_whole_ = 0;  // the mapping thread's: fused frames since the last that was kept whole
    Wake wake_;
    FifoQueue<Question> questions_{1, wake_};
    FifoQueue<Answer> answers_;
    FifoQueue<Update> updates_;
    const BlockMap* last_map_ = nullptr;  // of the mapping thread, which waits in Finish
    MapVersion last_version_;
    std::atomic<bool> saved_;
    std::atomic<bool> seeking_{true}, settled_{false};
    enum class Asked { kNo, kYes, kGiven };
    std::atomic<Asked> map_{Asked::kNo};  // for a copy of the map in use
    // The thread's; the caller's after Finish.
    std::unique_ptr<LoopCloser> closer_;
    LoopJournal journal_;
    int world_ = 0;
    std::vector<Eigen::Isometry3d> history_;  // corrections of this world
    // Parallel loops run on this thread alone, so that they take no TBB workers from tracking and
    // mapping.
    tbb::task_arena alone_{1};
    Worker<Job> worker_;
};

}  // namespace tessera
