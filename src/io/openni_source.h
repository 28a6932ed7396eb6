// Live cameras (Kinect, Xtion ...) and .oni recordings through OpenNI2, as a frame source. What can
// go wrong with a camera while it scans is a value: unplugged, silent, or sending garbage.
// docs/camera.md tells a person about it.
#pragma once

#include <memory>
#include <string>

#include "core/status.h"
#include "io/frame_source.h"
#include "io/openni_config.h"

namespace tessera {

// `name`: "openni2:" (the first device), "openni2:URI" (as `tessera doctor` lists them) or
// "FILE.oni". Errors, one line: no device, in use, not such a file, no OpenNI2 in this build.
//
// Read returns within half a second. kSkip: an image was unusable (wrong size, empty, a stamp that
// goes back or is absurd). kWait with a message: the camera was unplugged (the source then waits
// for it and goes on, with stamps that still increase, when a device of that URI or kind is back),
// a stream is silent for a second, or images are without a partner. A recording ends with kEnd.
// Stamps are the device's, in seconds. The source does not seek.
Result<std::unique_ptr<FrameSource>> OpenOpenniSource(const std::string& name,
                                                      const OpenniConfig& config);

}  // namespace tessera
