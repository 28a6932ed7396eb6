// Runs a detector on frames: as a step of the caller's thread (lockstep), or on a thread of its
// own, where the newest frame wins and the answer comes when it comes (live). A detector that
// breaks is reported once; labelling then stops and the run goes on.
#pragma once

#include <atomic>
#include <string>
#include <thread>
#include <vector>

#include "core/frame.h"
#include "core/queue.h"
#include "mapping/moving_mask.h"
#include "semantics/label_votes.h"
#include "semantics/open_detector.h"
#include "system/map_version.h"

namespace tessera {

// What a run hears of one detected frame.
struct LabelReport {
    double stamp_s = 0, colour_stamp_s = 0;
    std::vector<Detection> detections;  // the wanted ones
    // Of labels.dynamic's classes; without depth: none was detected.
    MovingHint moving;
    VoteCount votes;
    double detect_ms = 0, vote_ms = 0;
};

// Owner thread only.
class LabellingStage {
  public:
    LabellingStage(std::unique_ptr<Detector> detector, LabelClasses classes,
                   const LabelConfig& config, const PinholeCamera& camera)
        : detector_(std::move(detector)),
          classes_(std::move(classes)),
          config_(config),
          camera_(camera) {}

    // False once the detector broke: `message` says so the first time and is empty later.
    bool Detect(const Frame& frame, LabelReport& report, std::string& message);
    // On the thread that will detect, beside tracking: one thread only, and behind the others where
    // cores are short.
    void WorkInBackground();

  private:
    std::unique_ptr<Detector> detector_;
    LabelClasses classes_;
    LabelConfig config_;
    PinholeCamera camera_;
    bool broken_ = false;
};

// One thread, the mapping's, offers and takes.
class LabellingThread {
  public:
    // A frame whose pose is known, and in which map.
    struct Job {
        std::unique_ptr<Frame> frame;
        Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
        MapVersion map;
    };
    struct Answer {
        Job job;
        LabelReport report;
        std::string message;  // for a person; the report is then empty
    };

    // `mapping` is notified of answers.
    LabellingThread(LabellingStage stage, Wake& mapping);
    ~LabellingThread();  // stops after the frame at hand, and joins

    // Returns the frame that is not needed: an older one that still waited, or this one once
    // labelling has stopped.
    std::unique_ptr<Frame> Offer(Job job);
    bool has_answer() const { return !answers_.empty(); }
    bool TryTake(Answer& answer);

  private:
    void Work();

    LabellingStage stage_;
    Wake wake_;
    NewestQueue<Job> jobs_{1, wake_};
    FifoQueue<Answer> answers_;
    std::atomic<bool> stop_{false}, broken_{false};
    std::jthread thread_;  // last: ends before what it uses
};

}  // namespace tessera
