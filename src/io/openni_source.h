// Live cameras (Kinect, Xtion ...) and .oni recordings through OpenNI2, as a frame source. Camera
// problems during a scan are reported as values: unplugged, silent, or invalid data. The user
// documentation is docs/camera.md.
#pragma once

#include <memory>
#include <string>

#include "core/status.h"
#include "io/frame_source.h"
#include "io/openni_config.h"

namespace tessera {

// `name` is "openni2:" (the first device), "openni2:URI" (as listed by `tessera doctor`) or
// "FILE.oni". Errors, one line each: no device, in use, not an .oni file, no OpenNI2 in this build.
//
// Read returns within half a second. kSkip: an image is unusable (wrong size, empty, a stamp that
// goes back or is implausible). kWait with a message: the camera is unplugged, a stream has been
// silent for a second, or images have no partner. An unplugged source waits for a device with the
// same URI or of the same kind, then continues with increasing stamps. A recording ends with kEnd.
// Stamps are the device's, in seconds. The source cannot seek.
Result<std::unique_ptr<FrameSource>> OpenOpenniSource(const std::string& name,
                                                      const OpenniConfig& config);

}  // namespace tessera
