#include "system/loop_thread.h"

#include <fmt/format.h>

#include <utility>

#include "core/check.h"
#include "mapping/map_delta.h"

namespace tessera {

LoopThread::LoopThread(Settings settings, Surroundings surroundings)
    : settings_(std::move(settings)),
      around_(surroundings),
      answers_(2, around_.tracking),
      updates_(kUpdates, around_.mapping),
      saved_(settings_.saved),
      worker_(kJobs, [this](Job& job) { alone_.execute([&] { Do(job); }); },
              {.low_priority = true,
               .wake = &wake_,
               .has_idle_work = [this] { return HasIdleWork(); },
               .idle = [this] { alone_.execute([this] { WorkIdly(); }); },
               .begin = [this] { Begin(); },
               .end = [this](bool finished) { finished ? Conclude() : void(); }}) {}

// ---- Mapping thread.

void LoopThread::Offer(std::unique_ptr<TrackedFrame> tracked, std::unique_ptr<Frame> frame,
                       MapVersion map) {
    Job job;
    job.map = map;
    job.stamp_s = tracked->report.stamp_s;
    job.fused = tracked->report.fused;
    job.T_world_camera = tracked->report.track.T_world_camera;
    job.found_at = tracked->found_at;
    const int one_in = KeptOneIn(whole_.load());
    const bool whole = tracked->report.fused && one_in > 0 && ++since_whole_ >= one_in;
    if (whole) {
        since_whole_ = 0;
        whole_.fetch_add(1);
        job.tracked = std::move(tracked);
        job.frame = std::move(frame);
    }
    if (!worker_.TryPush(std::move(job))) {
        if (whole) whole_.fetch_sub(1);
        tracked = std::move(job.tracked);
        frame = std::move(job.frame);
    }
    around_.tracked_frames.Give(std::move(tracked));
    around_.frames.Give(std::move(frame));
}

void LoopThread::OfferDetections(std::int64_t frame_index, std::vector<Detection> detections,
                                 const ClassSet& ignored, MapVersion map) {
    Job job;
    job.kind = Job::Kind::kDetections;
    job.map = map;
    job.frame_index = frame_index;
    job.detections = std::move(detections);
    job.ignored = ignored;
    worker_.TryPush(std::move(job));
}

void LoopThread::Reset(MapVersion map) {
    Job job;
    job.kind = Job::Kind::kReset;
    job.map = map;
    worker_.PushOrWait(std::move(job));
}

void LoopThread::GiveMap(std::unique_ptr<BlockMap> copy, MapVersion map) {
    map_.store(Asked::kGiven);
    Job job;
    job.kind = Job::Kind::kMap;
    job.map = map;
    job.copy = std::move(copy);
    worker_.PushOrWait(std::move(job));
}

void LoopThread::EnableLabels(LoopCloser::Labels labels) {
    Job job;
    job.kind = Job::Kind::kLabels;
    job.labels = std::move(labels);
    worker_.PushOrWait(std::move(job));
}

void LoopThread::Settle() {
    settled_.store(true);
    Job job;  // once it is done, no correction is under way
    job.kind = Job::Kind::kSettle;
    worker_.PushOrWait(std::move(job));
    worker_.WaitUntilIdle();
}

bool LoopThread::TryTake(Update& update) {
    if (!updates_.TryPop(update)) return false;
    wake_.Notify();  // there is room for another correction
    return true;
}

// ---- The loop thread itself.

void LoopThread::Begin() {
    BeginWorld(0);
    if (auto memory = std::exchange(settings_.resumed, std::nullopt)) {
        closer_->Resume(std::move(*memory));
        journal_.Begin(*closer_);
    }
}

bool LoopThread::HasIdleWork() const { return !questions_.empty() || MayCorrect(); }

void LoopThread::WorkIdly() {
    if (!Reply() && MayCorrect()) Correct();
    ReportProblems();
}

void LoopThread::Correct() {
    constexpr int kFramesAtOnce = 2;  // of a map rebuild; a question waits at most this long
    if (closer_->WantsMap()) {
        map_.store(Asked::kYes);
        return around_.mapping.Notify();
    }
    if (auto change = closer_->Step(kFramesAtOnce)) HandOver(std::move(*change));
}

// At the end of the run nothing else runs, so this uses all cores.
void LoopThread::Conclude() {
    if (closer_->graph().corrected())
        around_.notices.Tell("optimising the corrected path once more; the map follows it");
    std::string note;
    const BlockMap* map = last_version_ == version() ? last_map_ : nullptr;
    if (auto change = closer_->Finish(note, map)) HandOver(std::move(*change), true);
    around_.notices.Tell(std::move(note));
    ReportProblems();
    if (saved_.load())
        Push({world_, std::nullopt, nullptr, journal_.Take(*closer_, LoopJournal::kAllFrames)});
}

void LoopThread::BeginWorld(int world) {
    world_ = world;
    history_.clear();
    closer_ =
        std::make_unique<LoopCloser>(settings_.loops, settings_.field, settings_.depth_units_per_m,
                                     settings_.labels, settings_.make_pager);
    journal_ = LoopJournal();
}

void LoopThread::Do(Job& job) {
    around_.mapping.Notify();  // there is room
    closer_->SetSeeking(seeking_.load());
    switch (job.kind) {
        case Job::Kind::kSettle: break;
        case Job::Kind::kReset: BeginWorld(job.map.world); break;
        case Job::Kind::kLabels:
            settings_.labels = std::move(job.labels);
            closer_->EnableLabels(*settings_.labels);
            break;
        case Job::Kind::kDetections:
            closer_->AddDetections(job.frame_index, std::move(job.detections), job.ignored);
            journal_.Touch(job.frame_index);
            break;
        case Job::Kind::kMap:
            map_.store(Asked::kNo);
            if (job.map == version()) closer_->Move(std::move(job.copy));
            break;
        case Job::Kind::kFrame: AddFrame(job);
    }
    Report();
    ReportProblems();
    // Before the next job: a lost camera does not wait for a long queue. Nor does a map that is
    // moved, as frames of which only the pose is kept are in it all the same.
    if (!Reply() && MayCorrect() && closer_->MovesMap()) Correct();
}

void LoopThread::AddFrame(Job& job) {
    Carry(history_, job.map.corrections, job.T_world_camera);
    if (job.found_at) closer_->LinkNextTo(*job.found_at);
    if (!job.tracked) return closer_->Pass(job.stamp_s, job.T_world_camera, job.fused);
    TrackedFrame& tracked = *job.tracked;
    tracked.report.track.T_world_camera = tracked.view.T_world_camera = job.T_world_camera;
    const std::string news =
        closer_->Add(*job.frame, tracked.prepared, tracked.report.track, tracked.view, true);
    if (!news.empty()) around_.notices.Tell(fmt::format("frame {}: {}", job.frame->index, news));
    whole_.fetch_sub(1);
    around_.tracked_frames.Give(std::move(job.tracked));
    around_.frames.Give(std::move(job.frame));
}

// Returns false if there was no question.
bool LoopThread::Reply() {
    Question question;
    if (!questions_.TryPop(question)) return false;
    Answer answer;
    answer.map = question.map;
    answer.stamp_s = question.stamp_s;
    answer.check = question.T_map_expected.has_value();
    // From before the last reset or correction, or after a reset that is still to be made here.
    answer.obsolete = question.map != version();
    if (!answer.obsolete)
        answer.found = closer_->Relocalise(question.stamp_s, *question.frame, answer.note,
                                           question.T_map_expected);
    TESSERA_CHECK(answers_.TryPush(std::move(answer)), "more answers than questions");
    return true;
}

void LoopThread::ReportProblems() { around_.notices.Tell(closer_->TakeError()); }

// News that does not fit is sent later, together with newer news.
void LoopThread::Report() {
    if (saved_.load() && updates_.size() < kUpdates - kForCorrections - 1)
        Push({world_, std::nullopt, nullptr, journal_.Take(*closer_)});
}

void LoopThread::Push(Update update) {
    TESSERA_CHECK(updates_.TryPush(std::move(update)), "more updates than the queue has room for");
}

// Tracking needs no copy of the last map.
void LoopThread::HandOver(LoopCloser::Correction change, bool last) {
    history_.push_back(change.T_new_old);
    Update update{world_, std::move(change), nullptr, {}};
    if (!last) update.field = CopyLayers(*update.correction->map, settings_.tracked_layers);
    if (saved_.load()) update.news = journal_.Take(*closer_);
    Push(std::move(update));
}

}  // namespace tessera
