// Global consistency: keyframes, loops between them, where they belong by the pose graph, and the
// map made again there; and the place of a camera that was lost. Reads frames as they are tracked
// and fused; never touches the map in use, but hands out a corrected one when it is ready.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "optimize/calibration_report.h"
#include "optimize/calibration_view.h"
#include "optimize/jump_detector.h"
#include "optimize/keyframes.h"
#include "optimize/loop_verifier.h"
#include "optimize/map_rebuild.h"
#include "optimize/place_index.h"
#include "optimize/pose_graph.h"

namespace tessera {

// Owner thread only. The same result for any number of threads.
class LoopCloser {
  public:
    // In place of the map so far; poses of cameras in it are to be moved likewise: T_new =
    // T_new_old * T_old.
    struct Correction {
        std::unique_ptr<BlockMap> map;
        std::unique_ptr<LabelMapper> labels;  // of the map, where labels are kept
        // The one that was made for the map, where they are; it has all of it.
        std::unique_ptr<MapPager> pager;
        Eigen::Isometry3d T_new_old = Eigen::Isometry3d::Identity();
    };

    struct Passage {  // a tracked frame
        double stamp_s = 0;
        int keyframe = 0;
        Eigen::Isometry3d T_keyframe_camera;
    };
    // What it takes to go on in another process.
    struct Memory {
        std::vector<Keyframe> keyframes;
        std::vector<PoseEdge> edges;
        std::vector<Passage> passages;
        std::vector<StoredFrame> frames;  // by increasing ordinal
        std::int64_t next_ordinal = 0;
        int loops = 0;
        bool corrected = false;
    };

    // Whether objects are labelled, and as what.
    struct Labels {
        LabelConfig config;
        LabelClasses classes;
    };

    // `make_pager`: for each corrected map one that keeps it within a memory limit; empty: there is
    // none.
    using MakePager = std::function<Result<std::unique_ptr<MapPager>>()>;
    LoopCloser(const LoopConfig& config, const FieldSettings& settings, double depth_units_per_m,
               std::optional<Labels> labels = std::nullopt, MakePager make_pager = {});

    // Before the first Add. A corrected map that was being made then is begun again.
    void Resume(Memory memory);

    // Every tracked frame, after its fusion, if it was fused. Returns what a person should know,
    // mostly empty.
    std::string Add(const Frame& frame, const PreparedFrame& prepared, const TrackResult& track,
                    const Integrator::View& view, bool fused);
    // What was seen in a frame that was added, whenever it is known.
    void AddDetections(std::int64_t frame_index, std::vector<Detection> detections) {
        store_.AddDetections(frame_index, std::move(detections));
    }
    // A tracked frame of which nothing but the pose is kept.
    void Pass(double stamp_s, const Eigen::Isometry3d& T_map_camera);
    // T_map_camera of a frame whose camera is lost; nothing if it was not here before, or if it
    // could be at two places. `note` says what was found.
    std::optional<Eigen::Isometry3d> Relocalise(const PreparedFrame& frame, std::string& note);
    // Works on the corrected map: fuses at most so many stored frames into it.
    std::optional<Correction> Step(int frames);
    // Whether Step has anything to do.
    bool HasWork() const { return rebuild_ != nullptr || moved_; }
    // Why the map is no longer corrected, for a person; mostly empty, and said once.
    std::string TakeTrouble() { return std::exchange(trouble_, {}); }
    // At the end: whatever is still to be corrected; the calibration, if it is to be refined:
    // `note` says what was found.
    std::optional<Correction> Finish(std::string& note);

    // The frames' poses as they are known now, in order.
    std::vector<StampedPose> Path() const;
    const Keyframes& keyframes() const { return keyframes_; }
    const std::vector<PoseEdge>& edges() const { return edges_; }
    const std::vector<Passage>& passages() const { return passages_; }
    int loops() const { return loops_; }
    bool corrected() const { return corrected_; }
    const FrameStore& store() const { return store_; }
    // After Finish, where the calibration was to be refined and enough was seen for an estimate.
    const std::optional<CalibrationReport>& calibration() const { return calibration_; }

  private:
    void AddKeyframe(const Frame& frame, const PreparedFrame& prepared, const TrackResult& track,
                     const Eigen::Isometry3d& T_map_expected);
    void Link(int from, int to, const Eigen::Isometry3d& T_map_to);
    void AddPassage(double stamp_s, const Eigen::Isometry3d& T_map_camera);
    std::string SeekLoop(const Keyframe& fresh, const PreparedFrame& prepared,
                         const FrameMotion& motion);
    std::string CloseLoop(const Keyframe& old, const Keyframe& fresh, const FieldVerdict& verdict);
    double FarthestOff_m(const std::vector<Eigen::Isometry3d>& T_map_keyframe) const;
    Status Optimise();
    Status LoadViews(std::vector<CalibrationView>& views);
    Status Calibrate();
    bool BeginRebuild(double tolerance_m);
    std::optional<Correction> StepRebuild(int frames);
    void GiveUp(const Status& why);

    LoopConfig config_;
    FieldSettings settings_;
    std::optional<Labels> labels_;
    MakePager make_pager_;
    Keyframes keyframes_;
    JumpDetector jumps_;
    PlaceIndex index_;
    FrameStore store_;
    LoopVerifier verifier_;
    std::vector<PoseEdge> edges_;
    std::vector<Passage> passages_;
    std::unique_ptr<MapRebuild> rebuild_;  // null when the map is right
    std::optional<int> relocalised_at_;    // the keyframe that the next one hangs on
    int loops_ = 0;
    bool corrected_ = false;  // some loop was worth it
    std::optional<CalibrationReport> calibration_;
    bool broken_ = false;  // no further map can be made
    std::string trouble_;
    bool moved_ = false;    // keyframes, since Step looked last
    bool swapped_ = false;  // the map, since the last keyframe
};

}  // namespace tessera
