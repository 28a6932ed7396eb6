// Notices when a camera's streams stop delivering images.
#pragma once

#include <string>

namespace tessera {

// Times are in seconds of one clock. Owner thread only.
class StreamWatch {
  public:
    explicit StreamWatch(double now_s) : depth_s_(now_s), colour_s_(now_s) {}

    void Heard(bool is_depth, double now_s) { (is_depth ? depth_s_ : colour_s_) = now_s; }
    // Nobody listened for so long: that is no silence of the camera.
    void NotHeard(double seconds) { depth_s_ += seconds, colour_s_ += seconds; }
    // Time since the last image of the stream that is silent for longer.
    double Silence_s(double now_s) const;
    // What the user should know about a silence of a second or more, once per silence. Usually
    // empty.
    std::string NewSilence(double now_s);

  private:
    double depth_s_, colour_s_;  // when the last image of each stream arrived
    bool told_ = false;
};

}  // namespace tessera
