#include "system/loop_thread.h"

#include <fmt/format.h>
#include <sys/resource.h>
#include <tbb/task_arena.h>
#include <unistd.h>

#include <utility>

#include "core/check.h"
#include "mapping/map_delta.h"

namespace tessera {
namespace {

// Linux: lowers the priority of this thread only. Its parallel loops also run on this thread alone,
// so that they take no TBB workers from tracking and mapping.
void LowerPriority() {
    constexpr int kNice = 10;
    setpriority(PRIO_PROCESS, static_cast<id_t>(gettid()), kNice);
}

}  // namespace

LoopThread::LoopThread(Settings settings, Surroundings surroundings)
    : settings_(std::move(settings)),
      around_(surroundings),
      answers_(2, around_.tracking),
      updates_(kUpdates, around_.mapping),
      news_(64, around_.mapping),
      saved_(settings_.saved) {
    BeginWorld(0);
    if (auto memory = std::exchange(settings_.resumed, std::nullopt)) {
        closer_->Resume(std::move(*memory));
        journal_.Begin(*closer_);
    }
    thread_ = std::jthread([this] {
        LowerPriority();
        tbb::task_arena(1).execute([this] { Work(); });
        if (!stop_.load()) Conclude();
        ended_.store(true);
        around_.mapping.Notify();
    });
}

LoopThread::~LoopThread() {
    stop_.store(true);
    wake_.Notify();
}

// ---- Mapping thread.

void LoopThread::Offer(std::unique_ptr<TrackedFrame> tracked, std::unique_ptr<Frame> frame,
                       MapVersion map) {
    Job job;
    job.map = map;
    job.stamp_s = tracked->report.stamp_s;
    job.T_world_camera = tracked->report.track.T_world_camera;
    const bool whole = tracked->report.fused && whole_.load() < kWhole;
    if (whole) {
        whole_.fetch_add(1);
        job.tracked = std::move(tracked);
        job.frame = std::move(frame);
    }
    if (!jobs_.TryPush(std::move(job))) {
        if (whole) whole_.fetch_sub(1);
        tracked = std::move(job.tracked);
        frame = std::move(job.frame);
    }
    around_.tracked_frames.Give(std::move(tracked));
    around_.frames.Give(std::move(frame));
}

void LoopThread::OfferDetections(std::int64_t frame_index, std::vector<Detection> detections,
                                 MapVersion map) {
    Job job;
    job.kind = Job::Kind::kDetections;
    job.map = map;
    job.frame_index = frame_index;
    job.detections = std::move(detections);
    jobs_.TryPush(std::move(job));
}

void LoopThread::Reset(MapVersion map) {
    Job job;
    job.kind = Job::Kind::kReset;
    job.map = map;
    around_.mapping.Wait([&] { return jobs_.TryPush(std::move(job)); });
}

bool LoopThread::TryTake(Update& update) {
    if (!updates_.TryPop(update)) return false;
    wake_.Notify();
    return true;
}

void LoopThread::Finish(const std::function<void(const std::string&)>& tell) {
    finish_.store(true);
    wake_.Notify();
    std::string news;
    while (true) {
        around_.mapping.Wait([this] { return ended_.load() || !news_.empty(); });
        const bool ended = ended_.load();
        while (news_.TryPop(news)) tell(news);
        if (ended) break;
    }
    thread_.join();
}

// ---- The loop thread itself.

void LoopThread::Work() {
    constexpr int kFramesAtOnce = 2;  // of a map rebuild; a question waits at most this long
    while (true) {
        wake_.Wait([&] {
            return stop_.load() || finish_.load() || !questions_.empty() || !jobs_.empty() ||
                   MayCorrect();
        });
        Question question;
        Job job;
        if (stop_.load()) return;
        if (questions_.TryPop(question)) {
            Reply(question);
        } else if (jobs_.TryPop(job)) {
            around_.mapping.Notify();
            Do(job);
            Report();
        } else if (finish_.load()) {
            return;
        } else if (auto change = closer_->Step(kFramesAtOnce)) {
            HandOver(std::move(*change));
        }
        ReportProblems();
    }
}

// At the end of the run nothing else runs, so this uses all cores.
void LoopThread::Conclude() {
    if (closer_->corrected())
        news_.Push(
            fmt::format("optimising the corrected path once more; where that moves the map, {} "
                        "frames are fused again",
                        closer_->store().frames().size()));
    std::string note;
    if (auto change = closer_->Finish(note)) HandOver(std::move(*change));
    if (!note.empty()) news_.Push(std::move(note));
    ReportProblems();
    if (saved_.load())
        Push({world_, std::nullopt, nullptr,
              journal_.Take(*closer_, closer_->store().frames().size())});
}

void LoopThread::BeginWorld(int world) {
    world_ = world;
    history_.clear();
    closer_ =
        std::make_unique<LoopCloser>(settings_.loops, settings_.field, settings_.depth_units_per_m,
                                     settings_.labels, settings_.make_pager);
    journal_.Begin(*closer_);
}

void LoopThread::Do(Job& job) {
    switch (job.kind) {
        case Job::Kind::kReset: return BeginWorld(job.map.world);
        case Job::Kind::kDetections:
            closer_->AddDetections(job.frame_index, std::move(job.detections));
            return journal_.Touch(job.frame_index);
        case Job::Kind::kFrame: return AddFrame(job);
    }
}

void LoopThread::AddFrame(Job& job) {
    Carry(history_, job.map.corrections, job.T_world_camera);
    if (!job.tracked) return closer_->Pass(job.stamp_s, job.T_world_camera);
    TrackedFrame& tracked = *job.tracked;
    tracked.report.track.T_world_camera = tracked.view.T_world_camera = job.T_world_camera;
    const std::string news =
        closer_->Add(*job.frame, tracked.prepared, tracked.report.track, tracked.view, true);
    if (!news.empty()) news_.Push(fmt::format("frame {}: {}", job.frame->index, news));
    whole_.fetch_sub(1);
    around_.tracked_frames.Give(std::move(job.tracked));
    around_.frames.Give(std::move(job.frame));
}

void LoopThread::Reply(Question& question) {
    Answer answer;
    answer.map = question.map;
    answer.stamp_s = question.stamp_s;
    // A question from before the last reset or correction is obsolete.
    if (question.map == MapVersion{world_, static_cast<int>(history_.size())})
        answer.T_world_camera = closer_->Relocalise(*question.frame, answer.note);
    TESSERA_CHECK(answers_.TryPush(std::move(answer)), "more answers than questions");
}

void LoopThread::ReportProblems() {
    if (std::string trouble = closer_->TakeError(); !trouble.empty())
        news_.Push(std::move(trouble));
}

// News that does not fit is sent later, together with newer news.
void LoopThread::Report() {
    if (saved_.load() && updates_.size() < kUpdates - kCorrections - 1)
        Push({world_, std::nullopt, nullptr, journal_.Take(*closer_)});
}

void LoopThread::Push(Update update) {
    TESSERA_CHECK(updates_.TryPush(std::move(update)), "more updates than the queue has room for");
}

void LoopThread::HandOver(LoopCloser::Correction change) {
    history_.push_back(change.T_new_old);
    Update update{world_, std::move(change), nullptr, {}};
    update.field = CopyField(*update.correction->map);
    if (saved_.load()) update.news = journal_.Take(*closer_);
    Push(std::move(update));
}

}  // namespace tessera
