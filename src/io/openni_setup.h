// Configures an opened OpenNI2 device: image sizes, frame rates, registration. Part of
// OpenniCamera.
#pragma once

#include "core/status.h"
#include "io/openni_camera.h"

namespace openni {
class Device;
class VideoStream;
}  // namespace openni

namespace tessera {

struct OpenniStreams {
    openni::Device& device;
    openni::VideoStream& depth;
    openni::VideoStream& colour;
};

// Creates both streams and fills `about`, except for uri and name. Recorded streams are used as
// they are.
Status SetUpOpenniStreams(const OpenniStreams& streams, bool is_recording,
                          const OpenniConfig& config, OpenniCamera::About& about);

// Starts both streams and applies the settings that devices accept only after that.
Status StartOpenniStreams(const OpenniStreams& streams, bool is_recording,
                          const OpenniConfig& config, OpenniCamera::About& about);

}  // namespace tessera
