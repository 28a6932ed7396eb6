// One OpenNI2 device or .oni recording that is open and gives colour and depth. The only files that
// know OpenNI2's own types are openni_camera.cpp, openni_setup.cpp and openni_runtime.cpp.
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
        std::string uri, name;  // of the device, "PrimeSense PS1080"; a recording's are its file
        PinholeCamera camera;
        double fps = 30;                      // the depth stream's
        double shortest_period_s = 1.0 / 30;  // between two images of the same stream
        double depth_units_per_m = 1000;
        std::int64_t frame_count = -1;  // of a recording: no more pairs than that
        bool frame_sync = false;
        std::vector<std::string> notes;  // what could not be had as asked for
    };
    enum class Event { kDepth, kColour, kNothing, kEnd };
    struct Arrival {
        Event event = Event::kNothing;
        std::uint64_t stamp_us = 0;
        int number = 0;     // the device's own
        std::string fault;  // why the image is unusable; it is then not copied
    };

    // `uri`: of a device, or a recording's path. Errors: in use, gone, no such streams, no common
    // size.
    static Result<std::unique_ptr<OpenniCamera>> Open(std::shared_ptr<OpenniRuntime> runtime,
                                                      const std::string& uri, bool is_recording,
                                                      const OpenniConfig& config);
    ~OpenniCamera();

    const About& about() const { return about_; }

    // Waits for an image of either stream, at most so long, and copies it into `depth` or `colour`.
    // kEnd: the recording is over; final.
    Arrival Wait(double seconds, Image<std::uint16_t>& depth, ColourImage& colour);

    bool WasUnplugged() const { return runtime_->WasUnplugged(about_.uri); }
    void StopFrameSync();

    // From now on the device's images go into this .oni file too, until the camera is closed. Once.
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
