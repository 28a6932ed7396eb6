// One frame of a source against the map of the frames before it, as a picture.
#pragma once

#include <cstdint>
#include <string>

#include "core/image.h"
#include "core/status.h"
#include "system/run_config.h"
#include "system/tracking_stage.h"

namespace tessera {

struct Inspection {
    ColourImage picture;  // render/view_picture.h
    FrameReport report;   // of the frame that is shown
};

// Tracks and fuses the frames before `frame` (an index as in frames.csv), tracks that one and
// predicts the view at its pose, by the ray caster or the rasteriser as tracking.icp.prediction
// says. Errors: bad source, no such frame, a frame that could not be read or was lost.
Result<Inspection> InspectFrame(const std::string& source, const RunConfig& config,
                                std::int64_t frame);

}  // namespace tessera
