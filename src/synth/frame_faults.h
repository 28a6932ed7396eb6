// What cables, drivers and cameras do to frames: put into a synthetic sequence on purpose, to see
// what a run makes of it.
#pragma once

#include <cstdint>
#include <optional>

#include "core/camera.h"
#include "core/config.h"
#include "core/frame.h"

namespace tessera {

enum class FrameFault {
    kBits,        // one bit in a thousand is wrong, in both images
    kBlocks,      // a third of the image comes from elsewhere in it
    kNear,        // depth times 0.1: a wrong scale
    kFar,         // depth times 10
    kStripes,     // every second band of rows is missing
    kSaturated,   // colour white, depth at the sensor's end
    kBlack,       // colour black, no depth
    kRepeated,    // the images of the last good frame, with a new time stamp
    kOutOfOrder,  // a time stamp half a second in the past
    kSwapped,     // each image in the place of the other
    kZoomed,      // as if from a camera with one and a half times the focal length
};
inline constexpr int kFrameFaults = 11;

// Every choice is a function of (seed, frame). Owner thread only.
class FrameFaults {
  public:
    struct Config {
        double share = 0;
        int in_a_row = 1;

        void Describe(ConfigParameters& parameters);
    };

    FrameFaults(const Config& config, const PinholeCamera& camera, std::uint64_t seed);

    // nullopt: the frame is good. So are the first thirty.
    std::optional<FrameFault> Of(std::int64_t frame) const;
    // Gives the frame its fault; remembers the images of a good one.
    void Apply(Frame& frame);

  private:
    Config config_;
    PinholeCamera camera_;
    std::uint64_t seed_;
    ColourImage last_colour_;
    DepthImage last_depth_m_;
};

// The fault itself. `random`: the key of its random numbers. kRepeated needs the last good images
// and is not done here.
void ApplyFault(FrameFault fault, const PinholeCamera& camera, std::uint64_t random, Frame& frame);

}  // namespace tessera
