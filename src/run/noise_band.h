// Fits the map's band to the camera: distances that scatter beyond it would bend the surface, and
// the frame would not fit its own map.
#pragma once

#include <atomic>
#include <memory>
#include <string>

#include "io/frame_source.h"
#include "system/pipeline_config.h"

namespace tessera {

// Looks at the frame at the selection's start and at one in each of the next seconds, or, where the
// source cannot seek, at its next frame, which it then delivers again. Waits about two seconds at
// most for a silent camera, and not once `stop` is set. Sets config.map.band_per_m, if it
// is 0, so that the band is `band_sigmas` standard deviations of the depth where truncation_m is
// less; leaves it 0 where truncation_m is enough at every depth that counts. Returns a message for
// the user if much of the view needs a wider band.
std::string FitBandToNoise(const FrameSelection& selection, PipelineConfig& config,
                           std::unique_ptr<FrameSource>& source, const std::atomic<bool>& stop);

}  // namespace tessera
