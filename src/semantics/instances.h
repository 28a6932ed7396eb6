// Assigns detections to objects ([D18] 3.4, figure 9) by comparing them with the labelled map seen
// from the same pose. Bookkeeping only: no images, no map.
//
// A detection on a region that no object holds starts a new object. One on a known object's region
// updates that object. One on a region held by an object of another class, or by one that no other
// detection explains, is ignored. An object is confirmed once it was seen often and steadily
// enough. It keeps its public number from then on and is never split. Two objects that turn out to
// be one are joined under the older number.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "core/state_stream.h"
#include "semantics/label_config.h"

namespace tessera {

// Internal number of an object, as stored in voxels; 0 = none. Numbers are not reused, so there are
// at most 65535.
using InstanceId = std::uint16_t;

// The numbers 1 to `last`, for loops: a counter of type InstanceId could not pass the largest one.
struct InstanceIds {
    struct Iterator {
        int id;
        InstanceId operator*() const { return static_cast<InstanceId>(id); }
        Iterator& operator++() {
            ++id;
            return *this;
        }
        bool operator==(const Iterator&) const = default;
    };
    Iterator begin() const { return {1}; }
    Iterator end() const { return {last + 1}; }

    InstanceId last = 0;
};

// One detection as measured against the map. All pixel counts use the same sampling grid. A pixel
// that several detections claim counts for each of them.
struct ObservedObject {
    int class_id = 0;
    float probability = 0;
    int pixels = 0;
    std::map<InstanceId, int> overlaps;  // pixels where the map shows that instance
    Eigen::AlignedBox3d box;             // of its points without outliers, world frame, metres
    Eigen::AlignedBox2d image_box = {};  // the detector's box, pixels
    // Those of `pixels` that no smaller detection claims.
    int own_pixels = 0;
    double area_m2 = 0;                  // of the sampled pixels, as if seen face on
    std::uint64_t mark = 0;              // identifies this detection
    std::vector<double> embedding = {};  // the detection's
};

// What the predicted view shows of an instance.
struct VisibleObject {
    int pixels = 0;
    Eigen::AlignedBox2d image_box = {};  // of these pixels without outliers, in pixels
};

struct InstanceRecord {
    std::map<int, double> class_votes;  // sums of probabilities
    std::map<int, int> class_counts;
    int observations = 0, visible_frames = 0;
    int held = 0;       // observations in which the map already showed it there
    int public_id = 0;  // from 1; 0 while not confirmed
    InstanceId merged_into = 0;
    bool dropped = false;
    Eigen::AlignedBox3d box;  // encloses the boxes of all its detections
    double area_m2 = 0;       // sum over its observations
    // The smallest marks of its detections, increasing. A sample that does not depend on their
    // order.
    std::vector<std::uint64_t> marks;
    int number_before = 0;          // set by KeepNumbersOf; becomes public_id on confirmation
    std::vector<double> embedding;  // sum over its detections, weighted by their probability
};

// Owner thread only.
class Instances {
  public:
    struct Config {
        int min_observations = 6;  // needed for confirmation
        double min_rate = 0.3;     // of the frames that show it
    };
    explicit Instances(const Config& config) : config_(config) {}

    // Processes the detections of one frame. `visible`: what the predicted view shows of each
    // instance. `not_sought`: classes that were not looked for, so that it says nothing about their
    // instances that they were not detected. Returns the instance of each detection, 0 if the
    // detection is ignored.
    std::vector<InstanceId> Match(const std::vector<ObservedObject>& observed,
                                  const std::map<InstanceId, VisibleObject>& visible,
                                  const ClassSet& not_sought = {});

    // Returns the instances that the detection covers almost fully and that no detection of this
    // frame matches. These are missed objects in front of it or on it. Instances of other classes
    // are included only if stands() is true. `match`: as returned by Match.
    std::vector<InstanceId> Covered(const ObservedObject& observed,
                                    const std::map<InstanceId, VisibleObject>& visible,
                                    const std::vector<InstanceId>& match) const;

    // Follows merges. Returns 0 for dropped instances.
    InstanceId Resolve(InstanceId id) const;
    // `id` must be resolved and not 0.
    const InstanceRecord& record(InstanceId id) const { return records_[id]; }
    bool confirmed(InstanceId id) const { return id != 0 && records_[id].public_id > 0; }
    // True if confirmed and detected in at least half of min_rate of the frames that show it. An
    // instance that was confirmed by a run of false detections fails this test later; it keeps its
    // number but is not reported.
    bool stands(InstanceId id) const;
    // Mean area that its detections saw, square metres.
    double SeenArea_m2(InstanceId id) const;
    // For instances rebuilt from (some of) the same detections, for a corrected map. Each object
    // takes the number of the old object with which it shares the most detections; the others get
    // new numbers.
    void KeepNumbersOf(const Instances& before);
    // Returns the class with the most votes; ties go to the smaller number.
    int ClassOf(InstanceId id) const;
    // Mean probability of the detections of that class, times their share of all detections.
    double Probability(InstanceId id) const;
    // Mean of its detections' embeddings, weighted by their probability, of length 1. Empty if no
    // detection had one.
    std::vector<float> Embedding(InstanceId id) const;
    void SaveState(StateWriter& state) const;
    bool LoadState(StateReader& state);
    InstanceId last() const { return static_cast<InstanceId>(records_.size() - 1); }
    InstanceIds ids() const { return {last()}; }  // all, also those that were joined or dropped

  private:
    struct PairEvidence {
        int together = 0, apart = 0;
    };

    void Assign(const std::vector<ObservedObject>& observed,
                const std::map<InstanceId, VisibleObject>& visible,
                std::vector<InstanceId>& match) const;
    InstanceId Add();  // 0: there is no number left
    void Update(InstanceId id, const ObservedObject& observed, int visible);
    void Judge(InstanceId id);
    bool Covers(const ObservedObject& observed, const std::map<InstanceId, VisibleObject>& visible,
                InstanceId id) const;
    void GatherEvidence(const std::vector<ObservedObject>& observed,
                        const std::map<InstanceId, VisibleObject>& visible,
                        const std::vector<InstanceId>& match);
    void Join(InstanceId a, InstanceId b);
    static void AddEmbedding(const std::vector<double>& embedding, double weight,
                             InstanceRecord& record);
    // At the end of the state, and only if there are any: older programs wrote none.
    void SaveEmbeddings(StateWriter& state) const;
    static bool LoadEmbeddings(StateReader& state, std::vector<InstanceRecord>& records);
    static void AddMarks(const std::vector<std::uint64_t>& marks, InstanceRecord& record);

    Config config_;
    std::vector<InstanceRecord> records_{1};
    // Key: the smaller id first.
    std::map<std::pair<InstanceId, InstanceId>, PairEvidence> evidence_;
    int last_public_ = 0;
};

}  // namespace tessera
