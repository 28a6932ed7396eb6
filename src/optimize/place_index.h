// Finds the keyframes with similar features. Locality-sensitive hashing of binary descriptors, with
// one vote for each descriptor that is really near. Needs no vocabulary to train or download, and
// grows with the scan.
#pragma once

#include <cstdint>
#include <span>
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
    static constexpr int kTables = 12, kBits = 18;

    std::size_t Key(int table, const Descriptor& descriptor) const;

    std::uint8_t bits_[kTables][kBits];
    int keyframes_ = 0;  // the last one's number plus one
    std::vector<Descriptor> descriptors_;
    std::vector<std::int32_t> keyframe_of_;  // by descriptor
    // A bucket is a chain of descriptors: its newest one, and for each, in each table, the one
    // before it; -1 at the end. That is 84 bytes a descriptor with the two above, and 19 MB.
    std::vector<std::int32_t> newest_, before_;
    std::vector<std::uint16_t> sizes_;  // of the buckets, counted until one is full
};

}  // namespace tessera
