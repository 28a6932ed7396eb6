// Runs a detector on frames: as a step on the caller's thread (lockstep), or on its own thread,
// where the newest frame wins and answers arrive asynchronously (live). A detector failure is
// reported once. Labelling then stops and the run continues. Frames without the colour that a
// detector needs are passed over; if the first ones all have none, that is a failure.
#pragma once

#include <atomic>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/frame.h"
#include "core/worker.h"
#include "mapping/moving_mask.h"
#include "semantics/label_votes.h"
#include "semantics/open_detector.h"
#include "system/map_version.h"

namespace tessera {

// The detector's result for one frame.
struct LabelReport {
    double stamp_s = 0;
    double colour_stamp_s = 0;          // as recorded, not as corrected
    std::vector<Detection> detections;  // wanted classes only
    ClassSet ignored;                   // classes whose detections were dropped before the vote
    // Depth of detections in labels.dynamic's classes. Empty depth image: none was detected.
    MovingHint moving;
    VoteCount votes;
    double detect_ms = 0, vote_ms = 0;
};

// Opens a detector by its name, as given to --labels. Called on the thread that detects.
using OpenDetectorFunction = std::function<Result<Labelling>(const std::string& name)>;

// What came of the choice of another detector.
struct DetectorChange {
    std::string message;  // for the user
    // Of the run, if the detector is in use now. Null: the one before stays.
    std::shared_ptr<const LabelClasses> classes;
    std::string detector = {};  // its name, if it is in use now
};

// What a run tells of a detector's failure.
std::string LabellingStopped(const std::string& why);

// Owner thread only.
class LabellingStage {
  public:
    // Without a detector yet.
    LabellingStage(const LabelConfig& config, const PinholeCamera& camera)
        : LabellingStage(nullptr, {}, config, camera) {}
    LabellingStage(std::unique_ptr<Detector> detector, LabelClasses classes,
                   const LabelConfig& config, const PinholeCamera& camera)
        : detector_(std::move(detector)),
          classes_(std::move(classes)),
          config_(config),
          camera_(camera) {}

    static constexpr int kMostWithoutColour = 30;  // frames, before any with colour

    // Returns false if nobody looked at the frame: it lacks colour, or the detector has failed.
    // `message` gives the error the first time and is empty after that.
    bool Detect(const Frame& frame, LabelReport& report, std::string& message);
    bool LacksColour(const Frame& frame) const {
        return detector_ && detector_->needs_colour() && frame.colour.empty();
    }
    bool broken() const { return broken_; }  // the detector has failed
    // Replaces the detector. The classes stay those of the first one, because the map's labels are
    // numbered by them; the new one must know one of them.
    DetectorChange Change(const std::string& name, const OpenDetectorFunction& open);
    // Call on the detecting thread when it runs beside tracking: limits the detector to it.
    void WorkInBackground() {
        in_background_ = true;
        if (detector_) detector_->WorkInBackground();
    }

  private:
    Status Check(const Detector& detector) const;

    std::unique_ptr<Detector> detector_;  // null: none was chosen yet
    LabelClasses classes_;
    LabelConfig config_;
    PinholeCamera camera_;
    bool broken_ = false, in_background_ = false, had_colour_ = false;
    int without_colour_ = 0;  // frames before any with colour
};

// Offer and TryTake: mapping thread only.
class LabellingThread {
  public:
    // A frame with a known pose, and the version of the map that the pose refers to.
    struct Job {
        std::unique_ptr<Frame> frame;
        Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
        MapVersion map;
    };
    struct Answer {
        Job job;
        bool looked_at = true;  // false: the frame only comes back
        LabelReport report;
        std::string message;  // for the user; if set, the report is empty
    };

    // `mapping` is notified of answers. `open`: see Change.
    LabellingThread(LabellingStage stage, OpenDetectorFunction open, Wake& mapping);

    // Returns a frame that is no longer needed: an older one that was still waiting, or this one if
    // labelling has stopped or two answers have not been taken yet.
    std::unique_ptr<Frame> Offer(Job job);
    bool has_answer() const { return !answers_.empty() || !changes_.empty(); }
    bool TryTake(Answer& answer) { return answers_.TryPop(answer); }
    // The detector has failed, and all that it had detected was taken.
    bool stopped() const { return broken_.load() && answers_.empty(); }
    // Opens another detector, while the present one goes on; see LabellingStage::Change.
    void Change(std::string name) { wanted_.Push(std::move(name)); }
    bool TryTake(DetectorChange& change) { return changes_.TryPop(change); }
    // Call after the last Offer, then take the answers. Waits until all frames offered were looked
    // at.
    void Finish() { worker_.Finish(); }

  private:
    void Detect(Job& job);
    void ChangeIfWanted();

    static constexpr std::size_t kUntaken = 2;

    LabellingStage stage_;
    const OpenDetectorFunction open_;
    Wake wake_;
    NewestQueue<std::string> wanted_{1, wake_};
    NewestQueue<DetectorChange> changes_;
    // Room for the untaken, a job in progress and one that waits.
    FifoQueue<Answer> answers_;
    std::atomic<bool> broken_{false};
    Worker<Job, NewestQueue> worker_;
};

}  // namespace tessera
