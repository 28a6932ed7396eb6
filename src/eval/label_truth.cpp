#include "eval/label_truth.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <sstream>

#include "core/input_file.h"
#include "io/image_io.h"
#include "io/trajectory.h"

namespace tessera {
namespace {

constexpr std::size_t kMaxListBytes = 1 << 26;
constexpr float kSameSurface_m = 0.02f;

// Counts the first three labels seen at a vertex. A vertex usually gets only one or two.
struct Tally {
    std::array<std::uint32_t, 3> key{};  // (class << 16 | instance) + 1; 0 = empty
    std::array<std::uint16_t, 3> count{};

    void Add(std::uint32_t value) {
        for (std::size_t i = 0; i < key.size(); ++i)
            if (key[i] == value || key[i] == 0) {
                key[i] = value;
                ++count[i];
                return;
            }
    }
    std::uint32_t Best() const {
        return key[static_cast<std::size_t>(std::ranges::max_element(count) - count.begin())];
    }
};

Status ReadClassNames(const std::string& path, std::map<int, std::string>& names) {
    const Result<std::string> text = ReadWholeFile(path, kMaxListBytes);
    if (!text.ok()) return text.status();
    std::istringstream lines(text.value());
    for (std::string line; std::getline(lines, line);) {
        std::istringstream words(line);
        int id = 0;
        std::string name;
        if (line.starts_with('#') || !(words >> id >> name)) continue;
        names[id] = name;
    }
    return names.empty() ? Status::Error(path + ": contains no classes") : Status::Ok();
}

void Look(const LabelTruth& truth, const TruthImages& images,
          const Eigen::Isometry3d& T_world_camera, const TriangleMesh& mesh,
          std::vector<Tally>& tallies) {
    const Eigen::Isometry3d T_camera_world = T_world_camera.inverse();
    tbb::parallel_for(
        tbb::blocked_range<std::size_t>(0, mesh.vertices.size(), 4096), [&](const auto& range) {
            for (std::size_t i = range.begin(); i < range.end(); ++i) {
                const Eigen::Vector3d p = T_camera_world * mesh.vertices[i].cast<double>();
                if (p.z() < 0.1) continue;
                const Eigen::Vector2d pixel = truth.camera.Project(p);
                if (!(std::abs(pixel.x()) < 1e5) || !(std::abs(pixel.y()) < 1e5)) continue;
                const int x = static_cast<int>(std::lround(pixel.x())),
                          y = static_cast<int>(std::lround(pixel.y()));
                if (!images.depth_m.Contains(x, y)) continue;
                const float z = images.depth_m(x, y);
                if (z <= 0 || std::abs(z - static_cast<float>(p.z())) > kSameSurface_m) continue;
                tallies[i].Add((static_cast<std::uint32_t>(images.class_id(x, y)) << 16 |
                                images.instance(x, y)) +
                               1);
            }
        });
}

}  // namespace

Result<LabelTruth> ReadLabelTruth(const std::string& folder) {
    LabelTruth truth;
    truth.folder = folder;
    for (const char* name : {"labels", "instances"})
        if (!std::filesystem::is_directory(folder + "/" + name))
            return Status::Error(folder + ": has no folder " + name +
                                 "/ with true labels; `tessera synth NAME --out DIR` creates such "
                                 "sequences");
    const Result<CameraCalibration> camera = ReadCameraFile(folder + "/camera.yaml");
    if (!camera.ok()) return camera.status();
    truth.camera = camera.value().pinhole;
    truth.depth_scale = camera.value().depth_scale;
    const Result<Trajectory> trajectory = ReadTrajectory(folder + "/groundtruth.txt");
    if (!trajectory.ok()) return trajectory.status();
    const Result<std::string> list = ReadWholeFile(folder + "/depth.txt", kMaxListBytes);
    if (!list.ok()) return list.status();
    std::istringstream lines(list.value());
    for (std::string line; std::getline(lines, line);) {
        std::istringstream words(line);
        double stamp_s = 0;
        std::string file;
        if (line.starts_with('#') || !(words >> stamp_s >> file)) continue;
        const auto T = InterpolatePose(trajectory.value().poses, stamp_s);
        if (!T) continue;
        truth.poses.push_back({stamp_s, *T});
        truth.depth_files.push_back(std::filesystem::path(file).filename().string());
    }
    if (truth.poses.empty())
        return Status::Error(folder + "/depth.txt: no image has a pose in groundtruth.txt");
    if (Status status = ReadClassNames(folder + "/classes.txt", truth.class_names); !status.ok())
        return status;
    return truth;
}

Status ReadTruthImages(const LabelTruth& truth, std::size_t frame, TruthImages& images) {
    const auto read = [&](const char* folder) {
        return ReadDepthImage(truth.folder + "/" + folder + "/" + truth.depth_files[frame]);
    };
    Result<Image<std::uint16_t>> depth = read("depth"), classes = read("labels"),
                                 instances = read("instances");
    for (const auto* image : {&depth, &classes, &instances}) {
        if (!image->ok()) return image->status();
        if (image->value().width() != truth.camera.width ||
            image->value().height() != truth.camera.height)
            return Status::Error(truth.folder + ": the images of " + truth.depth_files[frame] +
                                 " do not have the size given in camera.yaml");
    }
    images.depth_m.Resize(truth.camera.width, truth.camera.height);
    for (std::size_t i = 0; i < images.depth_m.size(); ++i)
        images.depth_m.data()[i] = static_cast<float>(depth.value().data()[i] / truth.depth_scale);
    images.class_id = std::move(classes.value());
    images.instance = std::move(instances.value());
    return Status::Ok();
}

Status LookUpVertices(LabelTruth& truth, const TriangleMesh& mesh, std::size_t stride,
                      std::vector<VertexLabel>& labels, std::vector<std::uint8_t>& seen) {
    std::vector<Tally> tallies(mesh.vertices.size());
    TruthImages images;
    for (std::size_t frame = 0; frame < truth.poses.size(); frame += stride) {
        if (Status status = ReadTruthImages(truth, frame, images); !status.ok()) return status;
        for (std::size_t i = 0; i < images.instance.size(); ++i)
            if (images.instance.data()[i] != 0)
                truth.class_of_instance[images.instance.data()[i]] = images.class_id.data()[i];
        Look(truth, images, truth.poses[frame].T_world_camera, mesh, tallies);
    }
    labels.assign(mesh.vertices.size(), {});
    seen.assign(mesh.vertices.size(), 0);
    for (std::size_t i = 0; i < tallies.size(); ++i) {
        const std::uint32_t best = tallies[i].Best();
        if (best == 0) continue;
        seen[i] = 1;
        labels[i] = {static_cast<std::uint8_t>((best - 1) >> 16),
                     static_cast<std::uint16_t>((best - 1) & 0xffff)};
    }
    return Status::Ok();
}

}  // namespace tessera
