#include "export/colmap_writer.h"

#include <fmt/format.h>

#include <Eigen/Geometry>

#include "export/image_set.h"
#include "io/file.h"

namespace tessera {
namespace {

std::string CamerasText(const PinholeCamera& c) {
    return fmt::format(
        "# CAMERA_ID MODEL WIDTH HEIGHT fx fy cx cy\n1 PINHOLE {} {} {:.9g} {:.9g} {:.9g} {:.9g}\n",
        c.width, c.height, c.fx, c.fy, c.cx + 0.5, c.cy + 0.5);
}

// Two lines per image. The second is for the points seen in the image, which we leave empty.
std::string ImageLines(std::size_t id, const Eigen::Isometry3d& T_world_camera,
                       const std::string& file_name) {
    const Eigen::Isometry3d T_camera_world = T_world_camera.inverse();
    Eigen::Quaterniond q(T_camera_world.linear());
    q.normalize();
    if (q.w() < 0) q.coeffs() = -q.coeffs();
    const Eigen::Vector3d t = T_camera_world.translation();
    return fmt::format("{} {:.12f} {:.12f} {:.12f} {:.12f} {:.9f} {:.9f} {:.9f} 1 {}\n\n", id,
                       q.w(), q.x(), q.y(), q.z(), t.x(), t.y(), t.z(), file_name);
}

std::string PointsText(const TriangleMesh& mesh) {
    const TriangleMesh points = SamplePoints(mesh, kSeedPoints);
    std::string text = "# POINT3D_ID X Y Z R G B ERROR TRACK[]\n";
    for (std::size_t i = 0; i < points.vertices.size(); ++i) {
        const Eigen::Vector3f& p = points.vertices[i];
        const Rgb8& c = points.colours[i];
        text += fmt::format("{} {:.6f} {:.6f} {:.6f} {} {} {} 0\n", i + 1, p.x(), p.y(), p.z(), c.r,
                            c.g, c.b);
    }
    return text;
}

}  // namespace

Result<std::vector<std::string>> WriteColmap(const std::string& scan_path, const TriangleMesh& mesh,
                                             const std::string& folder) {
    Result<std::unique_ptr<PosedFrames>> frames = PosedFrames::Open(scan_path);
    if (!frames.ok()) return frames.status();
    if (Status status = MakeImageFolder(folder + "/images"); !status.ok()) return status;
    std::string images = "# IMAGE_ID QW QX QY QZ TX TY TZ CAMERA_ID NAME, then an empty line\n";
    std::size_t id = 0;
    Status written = frames.value()->ForEach([&](const PosedFrame& frame) {
        const std::string file_name = frame.name + ".jpg";
        images += ImageLines(++id, frame.T_world_camera, file_name);
        return WriteImageFile(folder + "/images/" + file_name, frame.images->colour_jpeg);
    });
    if (!written.ok()) return written;
    if (Status status = WriteTextFile(folder + "/points3D.txt", PointsText(mesh)); !status.ok())
        return status;
    if (Status status =
            WriteTextFile(folder + "/cameras.txt", CamerasText(frames.value()->camera()));
        !status.ok())
        return status;
    if (Status status = WriteTextFile(folder + "/images.txt", images); !status.ok()) return status;
    return frames.value()->notes();
}

}  // namespace tessera
