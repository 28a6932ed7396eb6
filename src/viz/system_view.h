// The window's knowledge of the running system: the newest of everything received over the link,
// and its recent history.
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "system/viewer_link.h"
#include "viz/recent_frames.h"
#include "viz/series.h"

namespace tessera {

// Owner thread only.
class SystemView {
  public:
    struct PathPoint {
        Eigen::Vector3f position_m;  // world
        TrackStatus status = TrackStatus::kGood;
        // The previous point belongs to the previous frame; no tracking loss in between.
        bool follows = false;
    };
    struct History {
        Series decode_ms, prepare_ms, track_ms, fuse_ms, mesh_ms, latency_ms;
        Series inlier_percent, rms_mm, map_mb, dropped;
        std::map<std::string, Series> queued;  // by queue name
    };
    static constexpr std::size_t kMostMessages = 500;

    // Takes frames, images, labels and messages from the link; meshes go to the 3D view. `now_s`:
    // any steady clock. True if anything arrived.
    bool Take(ViewerLink& link, double now_s);
    // Sets the objects, instead of those from a link.
    void SetObjects(std::vector<MapObject> objects);
    // Adds a message of the window itself.
    void Say(const std::string& text);

    bool has_frame() const { return has_frame_; }
    const FrameUpdate& frame() const { return frame_; }
    double fps() const { return fps_; }  // over the last seconds
    const std::vector<PathPoint>& path() const { return path_; }
    const std::vector<PathPoint>& truth() const { return truth_; }
    // Where the camera was last; empty before the first pose.
    std::optional<Eigen::Vector3d> place() const {
        if (path_.empty()) return std::nullopt;
        return path_.back().position_m.cast<double>();
    }
    // Changes when the paths start over.
    std::uint64_t path_identity() const { return path_identity_; }
    const ImageUpdate& images() const { return images_; }  // `frame` is null before the first one
    std::uint64_t images_taken() const { return images_taken_; }
    const std::vector<MapObject>& objects() const { return objects_; }  // sorted by number
    std::uint64_t objects_taken() const { return objects_taken_; }
    const LabelUpdate& labels() const { return labels_; }      // with the newest detections
    const LabelClasses& classes() const { return classes_; }   // none without labels
    const std::string& detector() const { return detector_; }  // in use, if chosen during the run
    // Frames processed by the detector per second, over the last seconds; 0: not known yet.
    double detections_per_s() const { return detections_per_s_; }
    const RecentFrames& recent() const { return recent_; }
    const History& history() const { return history_; }
    const std::deque<std::string>& messages() const { return messages_; }  // oldest first
    std::uint64_t messages_said() const { return messages_said_; }

  private:
    bool TakeLabels(ViewerLink& link, double now_s);
    void Add(FrameUpdate&& update, double now_s);
    void AddToHistory();

    FrameUpdate frame_;
    bool has_frame_ = false;
    double fps_ = 0;
    std::deque<double> arrivals_s_;
    std::vector<PathPoint> path_, truth_;
    std::uint64_t path_identity_ = 1, images_taken_ = 0;
    ImageUpdate images_;
    LabelUpdate labels_;
    LabelClasses classes_;
    std::string detector_;
    std::vector<MapObject> objects_;
    std::uint64_t objects_taken_ = 0;
    std::deque<double> detected_s_;
    double detections_per_s_ = 0;
    RecentFrames recent_;
    History history_;
    std::deque<std::string> messages_;
    std::uint64_t messages_said_ = 0;
};

}  // namespace tessera
