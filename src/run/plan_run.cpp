#include "run/plan_run.h"

#include <filesystem>
#include <optional>

#include "io/mesh_io.h"
#include "plan/plan_objects.h"
#include "run/scanned.h"
#include "semantics/objects_file.h"

namespace tessera {
namespace {

// A camera that is held upright in a world whose `up` is up: a mesh has no path to tell.
Result<StampedPose> UprightCamera(const std::string& up) {
    const bool down = up.starts_with('-');
    const std::size_t axis = std::string("xyz").find(down ? up.substr(1) : up);
    if (up.size() != (down ? 2U : 1U) || axis == std::string::npos)
        return Status::Error("--up: \"" + up + "\" is no direction; use x, y, z, -x, -y or -z");
    const Eigen::Vector3d y =
        (down ? 1.0 : -1.0) * Eigen::Vector3d::Unit(static_cast<Eigen::Index>(axis));
    // It looks along y if that is level, so that a level mesh is not turned.
    const Eigen::Vector3d z = axis == 1 ? Eigen::Vector3d::UnitX() : Eigen::Vector3d::UnitY();
    StampedPose pose;
    pose.T_world_camera.linear() << y.cross(z), y, z;
    return pose;
}

Result<Scanned> FromMesh(const std::string& path, const std::string& up) {
    const Result<StampedPose> pose = UprightCamera(up.empty() ? "z" : up);
    if (!pose.ok()) return pose.status();
    Result<TriangleMesh> mesh = ReadPly(path);
    if (!mesh.ok()) return mesh.status();
    return Scanned{std::move(mesh.value()), {pose.value()}};
}

}  // namespace

Result<FloorPlan> PlanOfRun(const PlanRequest& request) {
    std::error_code ignored;
    const std::string& path = request.input;
    const bool is_mesh = std::filesystem::path(path).extension() == ".ply";
    const bool is_run = !is_mesh && std::filesystem::is_directory(path, ignored);
    Result<Scanned> scanned = is_mesh  ? FromMesh(path, request.up)
                              : is_run ? ReadRunFolder(path)
                                       : ReadScanFile(path);
    if (!scanned.ok()) return scanned.status();
    std::vector<MapObject> objects;
    if (const std::string file = path + "/objects.json";
        is_run && std::filesystem::exists(file, ignored)) {
        Result<std::vector<MapObject>> read = ReadObjects(file);
        if (!read.ok()) return read.status();
        objects = std::move(read.value());
    }
    if (!is_mesh && !request.up.empty()) {
        const Result<StampedPose> pose = UprightCamera(request.up);
        if (!pose.ok()) return pose.status();
        scanned.value().path = {pose.value()};
    }
    Result<FloorPlan> plan =
        MakeFloorPlan(scanned.value().mesh, scanned.value().path, request.options);
    if (!plan.ok()) return Status::Error(path + ": " + plan.message() + " (which way is up: --up)");
    AddObjects(objects, plan.value());
    return plan;
}

}  // namespace tessera
