#include "io/openni_config.h"

namespace tessera {

void OpenniConfig::Describe(ConfigParameters& p) {
    p.Add("fx", fx, {0, 1e5}, "px",
          "focal length along x of a camera or .oni recording; 0 takes it from the device (from "
          "its fields of view, accurate to about 1 %); set all four values if the camera is "
          "calibrated");
    p.Add("fy", fy, {0, 1e5}, "px", "focal length along y; 0 takes it from the device");
    p.Add("cx", cx, {0, 16384}, "px", "principal point, x; 0 takes the image centre");
    p.Add("cy", cy, {0, 16384}, "px", "principal point, y; 0 takes the image centre");
    p.Add("calibration", calibration,
          "camera file, as tessera calibrate writes it; empty takes the one that is kept for the "
          "camera's serial number, if there is one; none takes the device's own values");
    p.Add("registration", registration,
          "let the device register depth to its colour camera; turn it off if its registration is "
          "broken; colours are then offset from their surface");
    p.Add("frame_sync", frame_sync,
          "let the device capture colour and depth at the same time if it can; turned off "
          "automatically if no images arrive");
    p.Add("auto_exposure", auto_exposure,
          "let the camera adjust its exposure continuously; off holds it, for evenly lit scenes");
    p.Add("auto_white_balance", auto_white_balance,
          "let the camera adjust its white balance continuously; off holds it");
    p.Add(
        "max_pair_gap_s", max_pair_gap_s, {1e-4, 1.0}, "s",
        "colour and depth images whose time stamps differ by this much or more are not paired and "
        "are dropped");
    p.AddChoice(
        "playback", playback, {{"fast", Playback::kFast}, {"recorded", Playback::kRecorded}},
        "for .oni files: fast reads every frame as fast as the program can take it; recorded "
        "plays at the recorded rate, like a live camera");
}

}  // namespace tessera
