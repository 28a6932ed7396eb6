// Recorded sequences in folders of images: TUM RGB-D, ICL-NUIM, 7-Scenes, or any with a camera.yaml
// (folder_layout.h says how each is recognised and paired).
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "core/camera.h"
#include "core/config.h"
#include "core/status.h"
#include "io/frame_source.h"

namespace tessera {

struct FolderSourceConfig {
    double max_pair_gap_s = 0.02;  // colour and depth at least this far apart in time are no pair
    bool rectify = true;           // correct the lens distortion that camera.yaml gives
    double depth_scale = 0;        // stored depth value of one metre; 0 = as the camera file says
    bool swap_red_blue = false;    // of .klg logs
    // In place of what the camera file says; no key, the program's own. Its size counts for
    // nothing, the lens's distortion stays.
    std::optional<PinholeCamera> camera = std::nullopt;

    void Describe(ConfigParameters& parameters);
    Status Validate() const;
};

// Reads what the folder holds and decodes a few of its frames; the error names the file and what to
// do if none of them is usable. The source seeks. A frame that cannot be read is kSkip; the source
// itself does not judge depths.
Result<std::unique_ptr<FrameSource>> OpenFolderSource(const std::string& path,
                                                      const FolderSourceConfig& config);

}  // namespace tessera
