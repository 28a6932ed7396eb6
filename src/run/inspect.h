// Renders one frame of a source next to the view predicted from the map of all earlier frames.
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
    FrameReport report;   // of the inspected frame
};

// Tracks and fuses all frames before `frame` (an index as in frames.csv). Then tracks that frame
// and predicts the view at its pose, with the ray caster or the rasteriser as
// tracking.icp.prediction says. Errors: bad source, no such frame, or the frame could not be read
// or was lost.
Result<Inspection> InspectFrame(const std::string& source, const RunConfig& config,
                                std::int64_t frame);

}  // namespace tessera
