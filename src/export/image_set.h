// Shared code for exporting posed images: a scan's raw frames with their poses, output folders, and
// surface points to start from.
#pragma once

#include <Eigen/Geometry>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/image.h"
#include "core/mesh.h"
#include "core/status.h"
#include "scan/scan_content.h"

namespace tessera {

// A frame of a scan that has a pose and colour.
struct PosedFrame {
    std::string name;  // its number on the scan's path, six digits
    Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
    std::shared_ptr<const EncodedImages> images;
    const DepthImage& depth_m;  // decoded
};

// Owner thread only. Errors name the file. If the scan has no raw frames, or none with a pose and
// colour, the error says what to do.
class PosedFrames {
  public:
    static Result<std::unique_ptr<PosedFrames>> Open(const std::string& scan_path);

    // The ideal pinhole camera of the images. Lens distortion was corrected before the scan was
    // made.
    const PinholeCamera& camera() const { return scan_.meta.camera; }
    double depth_units_per_m() const { return scan_.meta.depth_units_per_m; }
    // Visits the frames in path order, with one in memory at a time. Frames that cannot be decoded
    // are left out and counted. Stops early if `take` returns an error. An error if no frame is
    // left.
    Status ForEach(const std::function<Status(const PosedFrame&)>& take);
    // After ForEach: what the user should know of frames that were left out; usually nothing.
    const std::vector<std::string>& notes() const { return notes_; }

  private:
    std::unique_ptr<ScanFile> file_;
    ScanContent scan_;  // without map and frames
    std::vector<std::string> notes_;
};

// Creates the folder. Refuses a folder that contains anything, so that no images are overwritten.
Status MakeImageFolder(const std::string& path);

Status WriteImageFile(const std::string& path, std::span<const std::uint8_t> bytes);

// At most `count` of the mesh's vertices, evenly spaced in its list, with their colours (grey if it
// has none); no triangles.
TriangleMesh SamplePoints(const TriangleMesh& mesh, std::size_t count);

// Number of initial points for such programs: enough to start from, few enough to read as text.
inline constexpr std::size_t kSeedPoints = 100000;

}  // namespace tessera
