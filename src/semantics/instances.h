// Which detection is which object ([D18] 3.4, figure 9): detections are compared with what the
// labelled map shows from the same pose. Bookkeeping only: no images, no map.
//
// A detection on a region that no object holds is a new one; on a known object's region it updates
// that one; on a busy region that belongs to an object of another class, or that no other detection
// explains, it says nothing. An object counts once it was seen often and steadily enough, keeps its
// public number from then on, and is never split. Two that prove to be one are joined under the
// older number.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "core/state_stream.h"

namespace tessera {

// Internal number of an object, 0 = none; what voxels hold. Never used twice, until there are
// 65535.
using InstanceId = std::uint16_t;

// One detection as the map sees it. Pixels are counted on one sampling grid for all; what several
// detections claim counts for each.
struct ObservedObject {
    int class_id = 0;
    float probability = 0;
    int pixels = 0;
    std::map<InstanceId, int> overlaps;  // pixels where the map shows that instance
    Eigen::AlignedBox3d box;             // of its points, world frame, metres
    Eigen::AlignedBox2d image_box = {};  // the detector's, pixels
    // Of `pixels`, those that no other detection before it claims.
    int own_pixels = 0;
    double area_m2 = 0;      // of those seen face on
    std::uint64_t mark = 0;  // tells this detection from all others
};

// What the predicted view shows of an instance.
struct VisibleObject {
    int pixels = 0;
    Eigen::AlignedBox2d image_box = {};  // around them but for strays, pixels
};

struct InstanceRecord {
    std::map<int, double> class_votes;  // sums of probabilities
    std::map<int, int> class_counts;
    int observations = 0, visible_frames = 0;
    int held = 0;       // observations in which the map showed it there already
    int public_id = 0;  // from 1 on; 0 while not confirmed
    InstanceId merged_into = 0;
    bool dropped = false;
    Eigen::AlignedBox3d box;  // of all its detections' points
    double area_m2 = 0;       // sum over its observations
    // The smallest of its detections', increasing: a sample, whatever the order.
    std::vector<std::uint64_t> marks;
    int number_before = 0;  // by KeepNumbersOf: public_id once confirmed
};

// Owner thread only.
class Instances {
  public:
    struct Config {
        int min_observations = 6;  // to be confirmed
        double min_rate = 0.3;     // of the frames that show it
    };
    explicit Instances(const Config& config) : config_(config) {}

    // One detected frame. `visible`: sampled pixels of each instance in the predicted view. Returns
    // the instance of each detection, 0 if it says nothing of any.
    std::vector<InstanceId> Match(const std::vector<ObservedObject>& observed,
                                  const std::map<InstanceId, VisibleObject>& visible);

    // The instances that the detection holds nearly whole and that none of the frame's detections
    // is of: missed ones, before or upon it; of other classes only those that stand. `match` as
    // Match returns it.
    std::vector<InstanceId> Covered(const ObservedObject& observed,
                                    const std::map<InstanceId, VisibleObject>& visible,
                                    const std::vector<InstanceId>& match) const;

    // Follows merges; 0 for those that turned out to be nothing.
    InstanceId Resolve(InstanceId id) const;
    const InstanceRecord& record(InstanceId id) const {
        return records_[id];
    }  // of a resolved one, not 0
    bool confirmed(InstanceId id) const { return id != 0 && records_[id].public_id > 0; }
    // Confirmed, and seen since in at least half of that rate: what was once confirmed by a run of
    // mistakes is withheld, though it keeps its number.
    bool stands(InstanceId id) const;
    // Mean area that its detections saw of it, square metres.
    double SeenArea_m2(InstanceId id) const;
    // For instances made again of (part of) the same detections, for a corrected map: an object
    // that they share the most detections with hands its number on, the others have new ones.
    void KeepNumbersOf(const Instances& before);
    // The class with the most votes; ties go to the smaller number.
    int ClassOf(InstanceId id) const;
    // Mean probability of the detections that gave it that class, times their share.
    double Probability(InstanceId id) const;
    void SaveState(StateWriter& state) const;
    bool LoadState(StateReader& state);
    InstanceId last() const { return static_cast<InstanceId>(records_.size() - 1); }

  private:
    struct PairEvidence {
        int together = 0, apart = 0;
    };

    void Assign(const std::vector<ObservedObject>& observed,
                const std::map<InstanceId, VisibleObject>& visible,
                std::vector<InstanceId>& match) const;
    InstanceId Add();
    void Update(InstanceId id, const ObservedObject& observed, int visible);
    void Judge(InstanceId id);
    bool Covers(const ObservedObject& observed, const std::map<InstanceId, VisibleObject>& visible,
                InstanceId id) const;
    void GatherEvidence(const std::vector<ObservedObject>& observed,
                        const std::map<InstanceId, VisibleObject>& visible,
                        const std::vector<InstanceId>& match);
    void Join(InstanceId a, InstanceId b);
    static void AddMarks(const std::vector<std::uint64_t>& marks, InstanceRecord& record);

    Config config_;
    std::vector<InstanceRecord> records_{1};
    // The smaller number first.
    std::map<std::pair<InstanceId, InstanceId>, PairEvidence> evidence_;
    int last_public_ = 0;
};

}  // namespace tessera
