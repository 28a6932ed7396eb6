// The detections of a stored frame, as they were voted into the map, with masks of one bit a pixel.
#pragma once

#include <cstdint>
#include <vector>

#include "semantics/detector.h"
#include "semantics/label_config.h"

namespace tessera {

class StoredDetections {
  public:
    // `ignored`: classes whose detections were dropped.
    explicit StoredDetections(std::vector<Detection> detections, const ClassSet& ignored = {});

    // As they were, but for mask values: 1 inside, 0 outside.
    std::vector<Detection> Unpack() const;
    const ClassSet& ignored() const { return ignored_; }
    std::size_t memory_bytes() const;  // on the heap

  private:
    struct Mask {
        int width = 0, height = 0;
        std::vector<std::uint8_t> bits;  // of a byte's pixels, the first has the lowest bit
    };

    std::vector<Detection> detections_;  // without masks
    std::vector<Mask> masks_;            // theirs
    ClassSet ignored_;
};

}  // namespace tessera
