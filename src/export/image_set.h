// What the sets of posed images for other programs have in common: a scan's raw frames with their
// poses, folders for them, and some points of the surface to begin with.
#pragma once

#include <Eigen/Geometry>
#include <functional>
#include <memory>
#include <span>
#include <string>

#include "core/mesh.h"
#include "core/status.h"
#include "scan/scan_content.h"

namespace tessera {

// One of a scan's frames that has a pose and colour.
struct PosedFrame {
    std::string name;  // its number on the scan's path, six digits
    Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
    StoredFrame stored;  // its images, as files
};

// Owner thread only. Errors name the file; for a scan without raw frames, or without any that has a
// pose and colour, they say how to keep them.
class PosedFrames {
  public:
    static Result<std::unique_ptr<PosedFrames>> Open(const std::string& scan_path);

    // Images are of this ideal pinhole: lens distortion was corrected before the scan was made.
    const PinholeCamera& camera() const { return scan_.meta.camera; }
    double depth_units_per_m() const { return scan_.meta.depth_units_per_m; }
    // In the order of the path, one in memory at a time, checked; ends early where `take` gives an
    // error.
    Status ForEach(const std::function<Status(const PosedFrame&)>& take);

  private:
    std::unique_ptr<ScanFile> file_;
    ScanContent scan_;  // without map and frames
};

// Makes the folder. One that holds anything already is refused: nobody's pictures are written over.
Status MakeImageFolder(const std::string& path);

Status WriteImageFile(const std::string& path, std::span<const std::uint8_t> bytes);

// At most `count` of the mesh's vertices with their colours (grey if it has none), evenly over its
// list; no triangles.
TriangleMesh SamplePoints(const TriangleMesh& mesh, std::size_t count);

// What such programs begin with: enough to start from, few enough to be read as text.
inline constexpr std::size_t kSeedPoints = 100000;

}  // namespace tessera
