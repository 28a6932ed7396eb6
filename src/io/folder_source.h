// Recorded sequences in image folders: TUM RGB-D, ICL-NUIM, 7-Scenes, or any folder with a
// camera.yaml (folder_layout.h describes how each is recognised and paired).
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "core/camera.h"
#include "core/config.h"
#include "core/depth_distortion.h"
#include "core/status.h"
#include "io/frame_source.h"

namespace tessera {

struct FolderSourceConfig {
    double max_pair_gap_s = 0;   // images this far apart or farther are not paired; 0: PairGap
    bool rectify = true;         // correct the lens distortion given in camera.yaml
    double depth_scale = 0;      // stored depth value of one metre; 0 = from the camera file
    bool swap_red_blue = false;  // for .klg logs
    // Of a ROS recording; empty: chosen by itself.
    std::string depth_topic = {}, colour_topic = {};
    double colour_delay_s = 0;  // colour was taken so much later than its time stamps say
    // Overrides the camera file's pinhole. Set by the program; not a configuration key. Its image
    // size is ignored, and the camera file's lens distortion still applies.
    std::optional<PinholeCamera> camera = std::nullopt;
    // Corrects the registration: colour lies this far right of and below where depth puts it, in
    // depth pixels. Set by the program; not a configuration key.
    Eigen::Vector2d colour_shift_px = Eigen::Vector2d::Zero();
    // Added to the camera file's. Set by the program; not a configuration key.
    double vignetting = 0;
    // Errors to take from depth, of any kind of source (CorrectDepth). Set by the program; not a
    // configuration key.
    DepthDistortion depth_distortion = {};

    bool operator==(const FolderSourceConfig&) const = default;
    void Describe(ConfigParameters& parameters);
    Status Validate() const;
};

// The calibration with what the configuration overrides.
CameraCalibration Configured(CameraCalibration calibration, const FolderSourceConfig& config);

// Reads the folder's layout and decodes a few of its frames. If none is usable, the error names the
// file and what to do. The source can seek. A frame that cannot be read returns kSkip. The source
// does not filter depth values.
Result<std::unique_ptr<FrameSource>> OpenFolderSource(const std::string& path,
                                                      const FolderSourceConfig& config);

}  // namespace tessera
