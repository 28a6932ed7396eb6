// Finds the keyframes with similar features. Locality-sensitive hashing of binary descriptors, with
// one vote for each descriptor that is really near. Needs no vocabulary to train or download, and
// grows with the scan.
#pragma once

#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

#include "optimize/features.h"

namespace tessera {

// Owner thread only.
class PlaceIndex {
  public:
    struct Candidate {
        int keyframe = 0;
        int votes = 0;  // number of query descriptors with a near one there

        bool operator==(const Candidate&) const = default;
    };

    PlaceIndex();

    // Add keyframes in increasing order, each once.
    void Add(int keyframe, std::span<const Descriptor> descriptors);
    // Returns at most `count` keyframes below `end` with at least `min_votes`, most votes first,
    // ties with the older one first.
    std::vector<Candidate> Query(std::span<const Descriptor> descriptors, int end, int count,
                                 int min_votes) const;

  private:
    struct Entry {
        std::int32_t keyframe, feature;
    };
    static constexpr int kTables = 12, kBits = 18;

    std::uint32_t Key(int table, const Descriptor& descriptor) const;

    std::uint8_t bits_[kTables][kBits];
    std::vector<std::vector<Descriptor>> descriptors_;  // by keyframe
    std::unordered_map<std::uint32_t, std::vector<Entry>> buckets_;
};

}  // namespace tessera
