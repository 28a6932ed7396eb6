// Brings an opened OpenNI2 device into the state that is wanted: sizes, rates, registration. Part
// of OpenniCamera.
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

// Creates both streams and fills `about`, except uri and name. A recording's streams are taken as
// they are.
Status SetUpOpenniStreams(const OpenniStreams& streams, bool is_recording,
                          const OpenniConfig& config, OpenniCamera::About& about);

// Starts both, and sets what devices take only from then on.
Status StartOpenniStreams(const OpenniStreams& streams, bool is_recording,
                          const OpenniConfig& config, OpenniCamera::About& about);

}  // namespace tessera
