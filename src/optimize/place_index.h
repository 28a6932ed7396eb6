// Which remembered views have features like these? Locality-sensitive hashing of binary descriptors
// with a vote for each that is really near: no vocabulary to train or to download, and it grows as
// the scan goes.
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
        int votes = 0;  // descriptors of the query that have a near one there

        bool operator==(const Candidate&) const = default;
    };

    PlaceIndex();

    // Keyframes are to be added in increasing order, each once.
    void Add(int keyframe, std::span<const Descriptor> descriptors);
    // The `count` keyframes below `end` with the most votes, and at least `min_votes`; most votes
    // first, of equal ones the older first.
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
