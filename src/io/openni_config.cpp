#include "io/openni_config.h"

namespace tessera {

void OpenniConfig::Describe(ConfigParameters& p) {
    p.Add("fx", fx, {0, 1e5}, "px",
          "focal length along x of a camera or .oni recording; 0 takes what the device says (its "
          "fields "
          "of view, good to about 1 %); set all four where the camera was calibrated");
    p.Add("fy", fy, {0, 1e5}, "px", "focal length along y; 0 takes what the device says");
    p.Add("cx", cx, {0, 16384}, "px", "principal point, x; 0 takes the image's centre");
    p.Add("cy", cy, {0, 16384}, "px", "principal point, y; 0 takes the image's centre");
    p.Add("registration", registration,
          "have the camera give depth as its colour camera sees it; off where it is broken, at the "
          "price of colours beside "
          "their surface");
    p.Add("frame_sync", frame_sync,
          "have the camera take colour and depth at the same moment where it can; turned off by "
          "itself if no images come so");
    p.Add("auto_exposure", auto_exposure,
          "the camera chooses its exposure all the time; off holds it, for scenes of even light");
    p.Add("auto_white_balance", auto_white_balance,
          "the camera balances its colours all the time; off holds them");
    p.Add("max_pair_gap_s", max_pair_gap_s, {1e-4, 1.0}, "s",
          "colour and depth images this far apart in time or farther are no pair and are left out");
    p.AddChoice("playback", playback,
                {{"fast", Playback::kFast}, {"recorded", Playback::kRecorded}},
                "of .oni files: every frame as fast as they are taken, or at the recorded pace, as "
                "if it were a camera");
}

}  // namespace tessera
