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
    // render/view_picture.h; with labels semantics/label_picture.h.
    ColourImage picture;
    FrameReport report;  // of the inspected frame
};

// Tracks and fuses all frames before `frame` (an index as in frames.csv). Then tracks that frame
// and predicts the view at its pose, with the ray caster or the rasteriser as
// tracking.icp.prediction says. `labels` (as for OpenLabelling; empty: none): objects are labelled
// as well, and the picture compares the frame's detections with the map's objects. Errors: bad
// source or detector, no such frame, or the frame could not be read or was lost.
Result<Inspection> InspectFrame(const std::string& source, const RunConfig& config,
                                const std::string& labels, std::int64_t frame);

}  // namespace tessera
