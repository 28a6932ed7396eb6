// Finds where a view belongs among the keyframes: that of a lost camera, of a new keyframe in
// another part of the scan, and of a new keyframe that closes a loop.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "optimize/loop_verifier.h"
#include "optimize/place_index.h"
#include "optimize/scan_graph.h"

namespace tessera {

// Where a lost camera is.
struct FoundCamera {
    Eigen::Isometry3d T_map_camera = Eigen::Isometry3d::Identity();
    int keyframe = 0;  // which shows the place
};

// Owner thread only.
class PlaceFinder {
  public:
    // A keyframe whose view a view shares.
    struct Place {
        int keyframe = 0;
        Eigen::Isometry3d T_old_new, T_map_camera;  // of the view
        double explained = 0;                       // FieldVerdict::explained
    };
    // A view as features and as what can be aligned directly; both of one frame.
    struct View {
        const Features& features;
        const DenseView& dense;
        const PreparedFrame& prepared;
    };
    using Allows = std::function<bool(int keyframe)>;

    // Both outlive the finder.
    PlaceFinder(const LoopConfig& config, const FieldSettings& settings, ScanGraph& graph,
                FrameStore& store)
        : config_(config), graph_(graph), store_(store), verifier_(settings, config) {}

    // Keyframes can be found from now on. In increasing order, each once.
    void Add(const Keyframe& keyframe) { index_.Add(keyframe.id, keyframe.features.descriptors); }

    // The best of the allowed places in each part of the scan that has one. A part with two places
    // that explain the view about equally well has none; `note` then names them for the user.
    std::vector<Place> BestOfParts(const View& view, const Allows& allows, std::string& note);

    // The old keyframe that a new one, made from the frame `prepared`, closes a loop with.
    struct Loop {
        int old = 0;
        FieldVerdict verdict;
    };
    // Once the errors of alignments are known, the places found become overlaps of the keyframe
    // instead, which show drift.
    std::optional<Loop> FindLoop(const Keyframe& fresh, const PreparedFrame& prepared,
                                 const FrameMotion& motion);

  private:
    std::vector<Place> PlacesOf(const View& view, const Allows& allows);
    const Place* BestOf(std::vector<Place>& places, const PreparedFrame& frame, std::string& note);
    bool ShowTheSame(const Keyframe& old, const Keyframe& fresh,
                     const Eigen::Isometry3d& T_old_new);

    LoopConfig config_;
    ScanGraph& graph_;
    FrameStore& store_;
    PlaceIndex index_;
    LoopVerifier verifier_;
};

}  // namespace tessera
