#include "io/folder_truth.h"

#include <Eigen/SVD>
#include <array>
#include <cmath>
#include <filesystem>
#include <sstream>

#include "core/input_file.h"
#include "io/trajectory.h"

namespace tessera {
namespace {

namespace fs = std::filesystem;

// Converts from ICL-NUIM's y-up, left-handed frames (world and camera) to right-handed frames with
// y down.
Eigen::Isometry3d ReflectY(const Eigen::Isometry3d& T) {
    const Eigen::DiagonalMatrix<double, 3> M(1, -1, 1);
    Eigen::Isometry3d reflected = Eigen::Isometry3d::Identity();
    reflected.linear() = M * T.linear() * M;
    reflected.translation() = M * T.translation();
    return reflected;
}

void AddTrajectory(const std::string& path, bool reflect, double max_gap_s, FolderLayout& layout) {
    const Result<Trajectory> truth = ReadTrajectory(path);
    if (!truth.ok()) {
        layout.notes.push_back("ground truth is not used: " + truth.message());
        return;
    }
    const Trajectory& trajectory = truth.value();
    if (!trajectory.notes.empty())
        layout.notes.push_back(fmt::format("ground truth, {} note{}: {}", trajectory.notes.size(),
                                           trajectory.notes.size() == 1 ? "" : "s",
                                           trajectory.notes.front()));
    std::size_t without = 0;
    for (FolderFrame& frame : layout.frames) {
        frame.T_world_camera = InterpolatePose(trajectory.poses, frame.depth_stamp_s, max_gap_s);
        if (!frame.T_world_camera)
            ++without;
        else if (reflect)
            frame.T_world_camera = ReflectY(*frame.T_world_camera);
    }
    if (reflect) layout.notes.push_back(path + ": poses are y-up; reflected to y-down");
    if (without > 0)
        layout.notes.push_back(fmt::format("{} of {} frames have no ground truth at their time",
                                           without, layout.frames.size()));
}

// Reads a 4 x 4 matrix from text. Returns nullopt if it is unreadable, not finite or not a rigid
// motion.
std::optional<Eigen::Isometry3d> ReadPoseMatrix(const std::string& path) {
    constexpr std::size_t kMaxBytes = 4096;
    // The data set rounds to 7 digits; a wrong file is far off.
    constexpr double kMaxDeviation = 1e-2;
    std::vector<std::uint8_t> bytes;
    if (!ReadFileBytes(path, kMaxBytes, bytes).ok()) return std::nullopt;
    std::istringstream text(std::string(bytes.begin(), bytes.end()));
    Eigen::Matrix4d matrix;
    for (int i = 0; i < 16; ++i)
        if (!(text >> matrix(i / 4, i % 4)) || !std::isfinite(matrix(i / 4, i % 4)))
            return std::nullopt;
    const Eigen::Matrix3d R = matrix.topLeftCorner<3, 3>();
    const bool rotation = (R * R.transpose()).isIdentity(kMaxDeviation) && R.determinant() > 0;
    if (!rotation || matrix.row(3) != Eigen::RowVector4d(0, 0, 0, 1)) return std::nullopt;
    const Eigen::JacobiSVD<Eigen::Matrix3d> svd(R, Eigen::ComputeFullU | Eigen::ComputeFullV);
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    T.linear() = svd.matrixU() * svd.matrixV().transpose();  // the nearest rotation
    T.translation() = matrix.topRightCorner<3, 1>();
    return T;
}

void AddPoseFiles(FolderLayout& layout) {
    constexpr std::string_view kDepthEnding = ".depth.png";
    std::size_t without = 0;
    for (FolderFrame& frame : layout.frames) {
        const std::string stem =
            frame.depth_path.substr(0, frame.depth_path.size() - kDepthEnding.size());
        frame.T_world_camera = ReadPoseMatrix(stem + ".pose.txt");
        without += !frame.T_world_camera;
    }
    if (without > 0)
        layout.notes.push_back(
            fmt::format("{} of {} frames have no usable .pose.txt", without, layout.frames.size()));
}

}  // namespace

std::string FindIclTruth(const std::string& folder) {
    std::string found;
    std::error_code error;
    for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
        if (!it->path().filename().string().ends_with(".gt.freiburg")) continue;
        if (!found.empty()) return {};
        found = it->path().string();
    }
    return found;
}

void AddTruth(const std::string& folder, bool stamps_are_frame_numbers, FolderLayout& layout) {
    const double max_gap_s = stamps_are_frame_numbers ? 1.0 : 0.1;
    const std::string truth = (fs::path(folder) / "groundtruth.txt").string();
    const std::string icl_truth = FindIclTruth(folder);
    std::error_code error;
    if (fs::exists(truth, error))
        AddTrajectory(truth, false, max_gap_s, layout);
    else if (!icl_truth.empty())
        AddTrajectory(icl_truth, true, max_gap_s, layout);
    else if (layout.kind == "7-Scenes sequence")
        AddPoseFiles(layout);
}

}  // namespace tessera
