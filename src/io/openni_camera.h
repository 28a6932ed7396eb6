// An open OpenNI2 device or .oni recording with colour and depth streams. Only openni_camera.cpp,
// openni_setup.cpp and openni_runtime.cpp use OpenNI2's types.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/camera.h"
#include "core/image.h"
#include "core/status.h"
#include "io/openni_config.h"
#include "io/openni_runtime.h"

namespace tessera {

// Owner thread only.
class OpenniCamera {
  public:
    struct About {
        std::string serial;     // number; "": the device does not say
        std::string uri, name;  // of the device, "PrimeSense PS1080"; for recordings, of the file
        PinholeCamera camera;   // as the device describes it
        CameraCalibration calibration;  // to use; a camera file's, if there is one
        bool camera_known = true;       // as in SourceInfo, for `calibration`
        std::string camera_from = "the device";
        double fps = 30;                      // of the depth stream
        double shortest_period_s = 1.0 / 30;  // between two images of the same stream
        double depth_units_per_m = 1000;
        std::int64_t frame_count = -1;  // recordings only: upper bound on the number of pairs
        bool frame_sync = false;
        std::vector<std::string> notes;  // requested settings that are not available
    };
    enum class Event { kDepth, kColour, kNothing, kEnd };
    struct Arrival {
        Event event = Event::kNothing;
        std::uint64_t stamp_us = 0;
        int number = 0;     // the device's own frame number
        std::string fault;  // why the image is unusable; it is then not copied
    };

    // `uri` is a device's URI or a recording's path. Errors: in use, gone, missing streams, no
    // common image size.
    static Result<std::unique_ptr<OpenniCamera>> Open(std::shared_ptr<OpenniRuntime> runtime,
                                                      const std::string& uri, bool is_recording,
                                                      const OpenniConfig& config);
    ~OpenniCamera();

    const About& about() const { return about_; }

    // Waits at most `seconds` for an image of either stream and copies it into `depth` or `colour`.
    // kEnd means that the recording is over; it is final.
    Arrival Wait(double seconds, Image<std::uint16_t>& depth, ColourImage& colour);

    bool WasUnplugged() const { return runtime_->WasUnplugged(about_.uri); }
    void StopFrameSync();

    // From now on, also records the device's images into this .oni file, until the camera is
    // closed. Call it at most once.
    Status Record(const std::string& path, bool lossless_colour);

  private:
    struct Streams;
    OpenniCamera(std::shared_ptr<OpenniRuntime> runtime, std::unique_ptr<Streams> streams,
                 About about, bool is_recording);

    std::shared_ptr<OpenniRuntime> runtime_;  // outlives the streams
    std::unique_ptr<Streams> streams_;
    About about_;
    bool is_recording_;
};

}  // namespace tessera
