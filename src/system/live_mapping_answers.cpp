// LiveMapping: what the threads of labelling and loop closure answer.
#include "core/check.h"
#include "core/memory.h"
#include "system/live_mapping.h"

namespace tessera {
namespace {

// A finished update comes first: the map that it replaces is not copied once more. In this order,
// as the thread hands over an update before it asks again.
bool WantsCopy(const LoopThread* loops) {
    return loops != nullptr && loops->wants_map() && !loops->has_update();
}

}  // namespace

bool LiveMapping::HasAnswers() const {
    return (labelling_ && labelling_->has_answer()) || UpdateFits() || life_.stage().following() ||
           WantsCopy(loops_.get());
}

void LiveMapping::TakeAnswers() {
    if (labelling_) TakeLabels();
    if (loops_) TakeLoops();
    if (life_.stage().following())
        life_.stage().Follow();
    else if (WantsCopy(loops_.get()))
        CopyMap();
}

void LiveMapping::TakeDetector(DetectorChange& change) {
    links_.notices.Tell(std::move(change.message));
    if (!change.classes) return;
    if (!life_.stage().has_labels()) {
        life_.stage().EnableLabels(config_.labels, *change.classes);
        if (loops_) loops_->EnableLabels({config_.labels, *change.classes});
    }
    FrameOutcome outcome;
    outcome.kind = FrameOutcome::Kind::kLabelsBegin;
    outcome.classes = std::move(change.classes);
    outcome.detector = std::move(change.detector);
    links_.outcomes.Push(std::move(outcome));
}

void LiveMapping::TakeLabels() {
    DetectorChange change;
    while (labelling_->TryTake(change)) TakeDetector(change);
    LabellingThread::Answer answer;
    while (labelling_->TryTake(answer)) {
        if (answer.job.map.world == world_ && life_.paging() != nullptr)
            life_.paging()->ReleaseHold(answer.job.frame->index);
        if (!answer.message.empty())
            links_.Report(FrameOutcome::Kind::kLabelsEnd, answer.message);
        else if (!answer.looked_at)
            last_detection_s_.reset();  // the next frame is looked at instead
        else if (answer.job.map.world == world_)
            TakeLabels(answer);
        links_.frames.Give(std::move(answer.job.frame));
    }
}

void LiveMapping::TakeLabels(LabellingThread::Answer& answer) {
    LabellingThread::Job& job = answer.job;
    Carry(corrections_, job.map.corrections, job.T_world_camera);
    life_.Label(job.frame->depth_m, job.T_world_camera, answer.report);
    if (!answer.report.moving.depth_m.empty())
        links_.hints.Push({std::move(answer.report.moving), job.T_world_camera, version()});
    if (loops_)
        loops_->OfferDetections(job.frame->index, answer.report.detections, answer.report.ignored,
                                job.map);
    FrameOutcome outcome;
    outcome.kind = FrameOutcome::Kind::kLabels;
    outcome.labels = std::move(answer.report);
    links_.outcomes.Push(std::move(outcome));
}

bool LiveMapping::UpdateFits() const {
    return loops_ && loops_->has_update() && links_.map_updates.size() < LiveLinks::kCorrections;
}

void LiveMapping::TakeLoops() {
    LoopThread::Update update;
    while (UpdateFits() && loops_->TryTake(update)) TakeUpdate(std::move(update), false);
}

// Some blocks a frame, so that fusion goes on. The copy, and the map that is made of it, need
// memory. With a device none is given, as only the device has all voxels.
void LiveMapping::CopyMap() {
    constexpr int kBlocks = 2048;  // 10 MB, a few milliseconds
    const BlockMap& map = life_.stage().blocks();
    if (one_thread_ || (!copier_.begun() && !MemoryHasRoomFor(2 * map.bytes())))
        return loops_->GiveMap(nullptr, version());
    if (auto copy = copier_.Copy(map, life_.stage().fused_frames(), kBlocks))
        loops_->GiveMap(std::move(copy), version());
}

// Puts the corrected map in place for mapping and the scan, and for tracking unless it has ended.
void LiveMapping::TakeUpdate(LoopThread::Update update, bool last) {
    if (update.world != world_) return;
    if (update.correction) {
        const Eigen::Isometry3d T_new_old = update.correction->T_new_old;
        life_.PutMap(std::move(*update.correction), copier_.copied(life_.stage().blocks()));
        copier_.Stop();
        std::unique_ptr<MapDelta> changes;
        if (!last && life_.stage().has_delta()) {
            changes = links_.deltas.Take();
            life_.stage().CollectDelta(*changes);
        }
        corrections_.push_back(T_new_old);
        if (!last)
            TESSERA_CHECK(links_.map_updates.TryPush(
                              {std::move(changes), world_, std::move(update.field), T_new_old}),
                          "more corrections than the queue has room for");
        links_.notices.Tell("map corrected");
        life_.SendMesh();
    }
    life_.AddLoops(std::move(update.news));
}

}  // namespace tessera
