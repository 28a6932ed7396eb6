// A colour camera that hangs, or one that is slower than its depth camera, delivers the same image
// again while the depth goes on. Noise makes each new image a different one. Owner thread only.
#pragma once

#include "core/frame.h"

namespace tessera {

class FrozenColour {
  public:
    // Whether the colour image is that of the last call, while the depth is not. False for a frame
    // without colour, and for an image of one single colour, which a renderer makes.
    bool Repeats(const Frame& frame);
    // The same, of the last call.
    bool repeats() const { return repeats_; }
    // That image has been repeated for so long that the camera hangs.
    bool hangs() const { return hangs_; }
    void Clear() { *this = {}; }

  private:
    std::size_t colour_ = 0, depth_ = 0;  // hashes of the last frame; 0: none
    double new_s_ = 0;                    // when the last new image came
    bool repeats_ = false, hangs_ = false;
};

}  // namespace tessera
