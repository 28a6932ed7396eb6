// A recording in the format of a camera's maker, an app or ROS. Each format is one Recording;
// RecordingSource (recording_source.h) makes frames of it.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/camera.h"
#include "core/image.h"
#include "core/status.h"

namespace tessera {

// One depth image and the colour image that belongs to it.
struct RecordedPair {
    double depth_stamp_s = 0, colour_stamp_s = 0;
};

// In the note of a recording that does not say its camera.
inline constexpr const char* kNoCameraInfo = "no camera_info";

struct RecordingInfo {
    std::string kind;                // "ROS 1 bag", "ScanNet recording", ...
    CameraCalibration depth_camera;  // with depth_scale: stored depth value of one metre
    // The format has depth in metres: depth_scale is how we store it, and nobody can know better.
    bool depth_in_m = false;
    CameraCalibration colour_camera;  // its depth_scale is not used
    // From the depth camera's frame to the colour camera's. Identity: depth is registered to
    // colour, though perhaps at another image size.
    Eigen::Isometry3d T_colour_depth = Eigen::Isometry3d::Identity();
    bool camera_known = true;  // false: the cameras are a guess, and a note says so
    std::string camera_from = "the recording";  // as in SourceInfo
    bool has_colour = true;                     // false: no pair has a colour image
    double fps = 30;
    std::vector<RecordedPair> pairs;           // depth stamps increase
    std::vector<std::string> notes, warnings;  // as in SourceInfo
};

// Whether both images are of one camera and size, so that nothing needs to be registered.
inline bool IsRegistered(const RecordingInfo& info) {
    return info.depth_camera.pinhole == info.colour_camera.pinhole &&
           info.depth_camera.distortion == info.colour_camera.distortion &&
           info.T_colour_depth.matrix().isIdentity(1e-9);
}

// Owner thread only. Content is not trusted: damage is a Status, and nothing allocates more than
// the file's size or 8192 x 8192 pixels. Never throws.
class Recording {
  public:
    virtual ~Recording() = default;

    virtual const RecordingInfo& info() const = 0;
    // Fills the raw images of pair `index`, in the size of their cameras; reuses their storage.
    // Empty colour: the recording has none. The error says what is wrong, without the file's name.
    virtual Status Load(std::size_t index, Image<std::uint16_t>& depth, ColourImage& colour) = 0;
};

// Opens a recording. Errors name the file and what to do.
using RecordingResult = Result<std::unique_ptr<Recording>>;

}  // namespace tessera
