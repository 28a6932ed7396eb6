// What a synthetic sequence showed of each object, gathered frame by frame, and the texts made of
// it. Owner thread only.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "synth/frame_renderer.h"
#include "synth/scene.h"

namespace tessera {

class SeenObjects {
  public:
    // Refers to the scene; `seed` decides the detector's mistakes.
    SeenObjects(const Scene& scene, std::uint64_t seed);

    // One frame: counts pixels, and notes detections of at least 400 pixels (of 640x480; in
    // proportion for others).
    void Add(const RenderedView& view, std::int64_t frame, double stamp_s);

    std::string ClassesText() const;     // classes.txt: "id name" a line
    std::string ObjectsJson() const;     // objects.json: instances that were seen
    std::string DetectionsText() const;  // detections.txt

  private:
    struct Count {
        std::int64_t frames = 0, max_pixels = 0;
    };
    const Scene& scene_;
    std::uint64_t seed_;
    std::vector<Count> counts_;  // one an instance
    std::string detections_;
};

}  // namespace tessera
