// What a recording shows about its camera before it is run.
#pragma once

#include <optional>

#include "io/frame_source.h"
#include "io/selected_frames.h"
#include "optimize/camera_estimate.h"
#include "optimize/colour_delay.h"
#include "optimize/colour_shift.h"
#include "optimize/depth_distortion_estimator.h"

namespace tessera {

// Nothing where they show too little.
struct FirstSeconds {
    std::optional<CameraEstimate> camera;
    std::optional<ColourShift> colour;
    std::optional<ColourDelay> delay;
};

// Reads the first eight seconds of the selection, ten frames of each, and leaves the source there.
// `one_camera`: colour and depth are of one camera, whose intrinsics are estimated.
// `colour_readout_s`: colour's read-out time as configured; 0 if it is not known. `vignetting` is
// taken off the images first.
FirstSeconds LookAtFirstSeconds(FrameSource& source, const FrameSelection& selection,
                                bool one_camera, double colour_readout_s, double vignetting = 0);

// Where there is hardly any texture, strong vignetting hides itself: views are aligned by shading,
// which moves with the camera, and then show none. So if `share` of it could go unseen, looks again
// at images without what it might be. `seen` becomes what these show if they show for certain that
// it is there. Does nothing if the source cannot seek.
void LookWithoutVignetting(FrameSource& source, const FrameSelection& selection, double share,
                           double colour_readout_s, FirstSeconds& seen);

// Reads ten frames of each second: of a selection of up to 20 s all, in parts of at least four
// seconds; of a longer one five parts of four seconds, evenly spread. Leaves the source there.
// Nothing if they show too little, or if the source cannot seek.
std::optional<DepthDistortionEstimate> LookAtDepth(FrameSource& source,
                                                   const FrameSelection& selection);

}  // namespace tessera
