// The mapping half of a frame's life, the same in both modes (frame_tracking.h is the other half):
// the map, and what follows it: the scan file, the memory limit and the window.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/notices.h"
#include "core/worker.h"
#include "optimize/loop_closer.h"
#include "system/engine.h"
#include "system/mapping_stage.h"
#include "system/paging_stage.h"
#include "system/scan_stage.h"
#include "system/viewer_feed.h"

namespace tessera {

// The thread that maps owns it. Messages for the user go to `notices`.
class FrameMapping {
  public:
    // `wait` (lockstep): waits for the scan file where live would postpone. `device` (null: CPU),
    // `viewer` (may be null) and `notices` outlive the object.
    FrameMapping(const RunConfig& config, const SourceInfo& source, Backend* device,
                 ViewerLink* viewer, bool wait, Notices& notices);

    // ---- Before the first frame.
    // Saves a scan from now on, unless the camera is only to be localised or the plan is empty.
    // Restores the map of one that is resumed, and returns the loop closure state to continue with.
    Result<std::optional<LoopCloser::Memory>> StartScan(ScanPlan plan);
    bool only_localise() const { return only_localise_; }

    // ---- A frame, in this order.
    // Loads what the camera may see near its last pose. Lockstep calls it before tracking.
    void Begin();
    // Fuses the frame, unless part of what it may see is not loaded.
    void Fuse(TrackedFrame& tracked, FrameOutcome& outcome);
    // Votes a frame's detections into the map, without those of ignored classes. The depth and the
    // pose are of the frame in which they were detected.
    void Label(const DepthImage& depth_m, const Eigen::Isometry3d& T_world_camera,
               LabelReport& report);
    // For the scan file: the frame, then what loop closure has learnt from it or earlier ones.
    // `labelled_frames`: see ScanStage.
    void Record(const Frame& frame, const TrackedFrame& tracked, std::int64_t labelled_frames,
                FrameOutcome& outcome);
    void AddLoops(LoopChanges changes);
    // Writes a checkpoint if one is due, and brings the map below its memory limit.
    void Save(FrameOutcome& outcome);
    // Shows the frame in the window and completes its outcome.
    void Report(const Frame& frame, const TrackedFrame& tracked, FrameOutcome& outcome);

    // ---- Loop closure.
    // Replaces the map by a corrected one. `moved_at`: if that was moved, the revision at which the
    // map in use was copied for it.
    void PutMap(LoopCloser::Correction correction, std::uint32_t moved_at = 0);
    // After StartScan: keeps a corrected map in the making within the memory limit, if there is
    // one.
    MakeMapPager MakePagers() const;
    // Lockstep: loads what a camera at this pose may see.
    void LoadAround(const Eigen::Isometry3d& T_world_camera);

    // ---- Commands of the user.
    // Replaces `config.labels.prediction` from the next Label on.
    void Apply(const LabelSettings& settings) { label_settings_ = settings; }
    bool labelling() const { return stage_.has_labels() && label_settings_.on; }
    void Reset();
    // Makes the mesh here, and writes it on a thread of its own.
    void SaveMesh(const std::string& path);
    // Saves the whole run so far, and what comes, to a new scan file.
    void SaveScan(const std::string& path);

    // ---- The end.
    // Call after the last frame: writes what the scan file lacks.
    void Finish();
    // Call once, after Finish. Releases the map. On error sets `status` and returns an empty mesh.
    // `keep_map`: does not release it, unless part of it is only in the scan file.
    TriangleMesh TakeMesh(Status& status, bool keep_map = false);
    // After Finish, while the stage has a map: what the user asks to be saved then. If a scan could
    // not be written, another path may be tried. `learnt`: by loop closure, all of it.
    void SaveAfterEnd(const ViewerCommand& command, const std::function<LoopChanges()>& learnt);

    MappingStage& stage() { return stage_; }
    const MappingStage& stage() const { return stage_; }
    // The map for a tracker on this thread.
    const BlockMap& MapFor(const TrackingStage& tracking) const {
        return tracking.reads_map() ? stage_.map() : stage_.blocks();
    }
    // Null if part of the map may be only in the scan file.
    const BlockMap* whole_map() const { return paging_ ? nullptr : &stage_.map(); }
    PagingStage* paging() { return paging_.get(); }  // null without a memory limit
    bool saving() const { return scan_.has_value(); }
    std::size_t checkpoints_waiting() const { return scan_ ? scan_->waiting() : 0; }
    ViewerFeed& feed() { return feed_; }
    void SendMesh() { feed_.SendMesh(stage_); }
    bool SendFinalMesh() { return feed_.SendFinalMesh(stage_); }

  private:
    Status Resume(ScanContent& scan);
    Status RefuseScan(Status why);
    Status StartPaging();
    TriangleMesh MakeFinalMesh(Status& status, bool keep_map);
    struct SavedMesh {
        std::string path, note;
        TriangleMesh mesh;
    };
    void WriteMesh(const SavedMesh& saved);
    std::string StartScanNow(const std::string& path);
    std::string ScanText(const char* if_saved) const;

    const RunConfig config_;
    const SourceInfo source_;
    const bool has_viewer_, wait_;
    bool only_localise_ = false, continued_ = false;  // a scan
    Notices& notices_;
    MappingStage stage_;
    std::optional<ScanStage> scan_;        // set if a scan is saved
    std::unique_ptr<PagingStage> paging_;  // null without a memory limit
    // With a window: frames so far, in case the user starts saving a scan mid-run, or at the end
    // another one.
    std::vector<PathRecord> past_;
    LabelSettings label_settings_;
    std::string labels_warning_;  // as last told
    ViewerFeed feed_;
    std::optional<Worker<SavedMesh>> mesh_writer_;  // from the first use on
};

}  // namespace tessera
