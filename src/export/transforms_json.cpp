#include "export/transforms_json.h"

#include <filesystem>
#include <nlohmann/json.hpp>
#include <span>

#include "export/image_set.h"
#include "io/file.h"
#include "io/image_io.h"
#include "io/mesh_writers.h"
#include "io/png_encoder.h"
#include "mapping/frame_kernels.h"

namespace tessera {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kDepthUnitsPerMetre = 1000;  // nerfstudio's default

Json Rows(const Eigen::Matrix4d& T, int rows) {
    Json all = Json::array();
    for (int r = 0; r < rows; ++r) all.push_back({T(r, 0), T(r, 1), T(r, 2), T(r, 3)});
    return all;
}

Json Head(const PinholeCamera& camera) {
    return {{"camera_model", "OPENCV"},
            {"w", camera.width},
            {"h", camera.height},
            {"fl_x", camera.fx},
            {"fl_y", camera.fy},
            {"cx", camera.cx + 0.5},
            {"cy", camera.cy + 0.5},
            {"k1", 0.0},
            {"k2", 0.0},
            {"p1", 0.0},
            {"p2", 0.0},
            {"aabb_scale", 16},
            {"integer_depth_scale", 1 / kDepthUnitsPerMetre},
            {"applied_transform", Rows(ZUpFromWorld().matrix(), 3)},
            {"ply_file_path", "points.ply"}};
}

// Writes depth images in the units and encoding that other programs expect.
class DepthFiles {
  public:
    explicit DepthFiles(double disparity_offset_per_m)
        : disparity_offset_per_m_(static_cast<float>(disparity_offset_per_m)) {}

    Status Write(const DepthImage& depth_m, const std::string& path) {
        corrected_m_ = depth_m;
        for (float& z_m : std::span(corrected_m_.data(), corrected_m_.size()))
            z_m = CorrectedDepth(z_m, disparity_offset_per_m_);
        StoreDepth(corrected_m_, kDepthUnitsPerMetre, depth_mm_);
        encoder_.EncodeDepth(depth_mm_, file_);
        return WriteImageFile(path, file_);
    }

  private:
    const float disparity_offset_per_m_;
    DepthImage corrected_m_;
    Image<std::uint16_t> depth_mm_;
    PngEncoder encoder_;
    std::vector<std::uint8_t> file_;
};

Status WritePoints(const TriangleMesh& mesh, const std::string& path) {
    TriangleMesh points = SamplePoints(mesh, kSeedPoints);
    const Eigen::Isometry3f T = ZUpFromWorld().cast<float>();
    for (Eigen::Vector3f& p : points.vertices) p = T * p;
    return WritePlyCloud(path, points);
}

Status WriteFrames(PosedFrames& frames, const std::string& folder, double disparity_offset_per_m,
                   Json& list) {
    DepthFiles depth(disparity_offset_per_m);
    const Eigen::Isometry3d T_opencv_opengl(
        Eigen::DiagonalMatrix<double, 3>(1, -1, -1).toDenseMatrix());
    return frames.ForEach([&](const PosedFrame& frame) {
        const std::string colour_name = "images/" + frame.name + ".jpg",
                          depth_name = "depth/" + frame.name + ".png";
        if (Status status = WriteImageFile(folder + colour_name, frame.images->colour_jpeg);
            !status.ok())
            return status;
        if (Status status = depth.Write(frame.depth_m, folder + depth_name); !status.ok())
            return status;
        const Eigen::Isometry3d T = ZUpFromWorld() * frame.T_world_camera * T_opencv_opengl;
        list.push_back({{"file_path", colour_name},
                        {"depth_file_path", depth_name},
                        {"transform_matrix", Rows(T.matrix(), 4)}});
        return Status::Ok();
    });
}

}  // namespace

Eigen::Isometry3d ZUpFromWorld() {
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    T.linear() << 1, 0, 0, 0, 0, 1, 0, -1, 0;
    return T;
}

Result<std::vector<std::string>> WriteTransforms(const std::string& scan_path,
                                                 const TriangleMesh& mesh,
                                                 const std::string& json_path,
                                                 double disparity_offset_per_m) {
    Result<std::unique_ptr<PosedFrames>> frames = PosedFrames::Open(scan_path);
    if (!frames.ok()) return frames.status();
    const std::string parent = std::filesystem::path(json_path).parent_path();
    const std::string folder = parent.empty() ? "./" : parent + "/";
    for (const char* name : {"images", "depth"})
        if (Status status = MakeImageFolder(folder + name); !status.ok()) return status;
    Json json = Head(frames.value()->camera());
    Json list = Json::array();
    if (Status status = WriteFrames(*frames.value(), folder, disparity_offset_per_m, list);
        !status.ok())
        return status;
    json["frames"] = std::move(list);
    if (Status status = WritePoints(mesh, folder + "points.ply"); !status.ok()) return status;
    if (Status status = WriteTextFile(json_path, json.dump(1) + "\n"); !status.ok()) return status;
    return frames.value()->notes();
}

}  // namespace tessera
