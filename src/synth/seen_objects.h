// Statistics of each object over the frames of a synthetic sequence, and the text files made from
// them. Owner thread only.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "synth/frame_renderer.h"
#include "synth/scene.h"

namespace tessera {

class SeenObjects {
  public:
    // Keeps a reference to the scene. `seed` determines the errors of the simulated detector.
    SeenObjects(const Scene& scene, std::uint64_t seed);

    // Adds one frame: counts pixels, and records detections of instances with more than 400 pixels
    // (at 640x480; scaled for other sizes).
    void Add(const RenderedView& view, std::int64_t frame, double stamp_s);

    std::string ClassesText() const;     // classes.txt: lines "id name"
    std::string ObjectsJson() const;     // objects.json: the instances that were seen
    std::string DetectionsText() const;  // detections.txt

  private:
    struct Count {
        std::int64_t frames = 0, max_pixels = 0;
    };
    const Scene& scene_;
    std::uint64_t seed_;
    std::vector<Count> counts_;  // one per instance
    std::string detections_;
};

}  // namespace tessera
