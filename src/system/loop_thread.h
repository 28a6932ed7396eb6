// Loop closure beside a live run: a thread of low priority that owns the LoopCloser. Mapping offers
// it what was fused and takes corrected maps from it; tracking asks it where a lost camera is.
// Nobody waits for it.
#pragma once

#include <atomic>
#include <functional>
#include <thread>

#include "core/pool.h"
#include "core/queue.h"
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
        // Updates carry news, for a scan file; else from BeginNews on.
        bool saved = false;
        std::optional<LoopCloser::Memory> resumed;  // of an earlier scan that goes on
        LoopCloser::MakePager make_pager = {};
    };
    // In this order they hold: news speak of the map as it is after the corrections before them and
    // with them.
    struct Update {
        int world = 0;
        std::optional<LoopCloser::Correction> correction;
        // The corrected map once more, for tracking: Layers::kFieldOnly.
        std::unique_ptr<BlockMap> field;
        LoopNews news;
    };
    // A lost camera's frame, and the answer: its pose, or nothing.
    struct Question {
        MapVersion map;
        double stamp_s = 0;
        std::unique_ptr<PreparedFrame> frame;
    };
    struct Answer {
        MapVersion map;
        double stamp_s = 0;
        std::optional<Eigen::Isometry3d> T_world_camera;
        std::string note;  // for a person
    };

    // Where the storage of frames comes from and goes to, and whom to notify of what is there for
    // them. All outlive this.
    struct Surroundings {
        Pool<Frame>& frames;
        Pool<TrackedFrame>& tracked_frames;
        Wake& mapping;
        Wake& tracking;
    };

    LoopThread(Settings settings, Surroundings surroundings);
    ~LoopThread();  // stops and joins

    // ---- Mapping's.
    // A tracked frame, after its fusion. Where too many wait only its pose is kept.
    void Offer(std::unique_ptr<TrackedFrame> tracked, std::unique_ptr<Frame> frame, MapVersion map);
    void OfferDetections(std::int64_t frame_index, std::vector<Detection> detections,
                         MapVersion map);
    // Waits where very many jobs wait.
    void Reset(MapVersion map);
    // From now on updates carry news, the next ones of all so far.
    void BeginNews() { saved_.store(true); }
    bool has_update() const { return !updates_.empty(); }
    bool TryTake(Update& update);
    // No more frames: waits until all is corrected, and tells meanwhile what a person should know.
    // What is left comes as updates.
    void Finish(const std::function<void(const std::string&)>& tell);
    // After Finish: the tracked frames' poses as they are known, and what was found of the
    // calibration.
    std::vector<StampedPose> Path() const { return closer_->Path(); }
    const std::optional<CalibrationReport>& calibration() const { return closer_->calibration(); }
    // For a person.
    bool TryTakeNews(std::string& news) { return news_.TryPop(news); }
    std::size_t waiting() const { return jobs_.size(); }

    // ---- Tracking's. One question at a time.
    bool Ask(Question question) { return questions_.TryPush(std::move(question)); }
    bool TryTake(Answer& answer) { return answers_.TryPop(answer); }
    bool has_answer() const { return !answers_.empty(); }

  private:
    struct Job {
        enum class Kind { kFrame, kDetections, kReset };
        Kind kind = Kind::kFrame;
        MapVersion map;
        double stamp_s = 0;
        Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
        std::unique_ptr<TrackedFrame> tracked;  // null, as frame: only the pose counts
        std::unique_ptr<Frame> frame;
        std::int64_t frame_index = 0;
        std::vector<Detection> detections;
    };

    void Work();
    void Conclude();
    void BeginWorld(int world);
    bool MayCorrect() const {
        return closer_->HasWork() && updates_.size() < kUpdates - kCorrections;
    }
    void Do(Job& job);
    void AddFrame(Job& job);
    void Reply(Question& question);
    void Tell();
    void TellTrouble();
    void Push(Update update);
    void HandOver(LoopCloser::Correction change);

    Settings settings_;
    Surroundings around_;
    // The last places are for corrections only.
    static constexpr std::size_t kJobs = 4096, kUpdates = 8, kCorrections = 3;
    static constexpr int kWhole = 16;  // frames that wait with their images, some 6 MB each
    Wake wake_;
    std::atomic<int> whole_{0};
    FifoQueue<Job> jobs_{kJobs, wake_};
    FifoQueue<Question> questions_{1, wake_};
    FifoQueue<Answer> answers_;
    FifoQueue<Update> updates_;
    NewestQueue<std::string> news_;
    std::atomic<bool> finish_{false}, stop_{false}, ended_{false}, saved_;
    // The thread's own; the caller's after Finish.
    std::unique_ptr<LoopCloser> closer_;
    LoopJournal journal_;
    int world_ = 0;
    std::vector<Eigen::Isometry3d> history_;  // corrections of this world
    std::jthread thread_;                     // last: ends before what it uses
};

}  // namespace tessera
