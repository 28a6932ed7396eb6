#include "run/plan_run.h"

#include <filesystem>
#include <optional>

#include "io/mesh_io.h"
#include "plan/plan_objects.h"
#include "run/scanned.h"
#include "semantics/objects_file.h"

namespace tessera {
namespace {

struct PlanInput {
    Scanned scanned;
    std::vector<MapObject> objects;
};

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

Result<PlanInput> FromMesh(const std::string& path, const std::string& up) {
    PlanInput input;
    const Result<StampedPose> pose = UprightCamera(up.empty() ? "z" : up);
    if (!pose.ok()) return pose.status();
    input.scanned.path.push_back(pose.value());
    Result<TriangleMesh> mesh = ReadPly(path);
    if (!mesh.ok()) return mesh.status();
    input.scanned.mesh = std::move(mesh.value());
    return input;
}

Result<PlanInput> FromFolder(const std::string& folder) {
    Result<Scanned> scanned = ReadRunFolder(folder);
    if (!scanned.ok()) return scanned.status();
    PlanInput input{std::move(scanned.value()), {}};
    const std::string file = folder + "/objects.json";
    std::error_code ignored;
    if (!std::filesystem::exists(file, ignored)) return input;
    Result<std::vector<MapObject>> objects = ReadObjects(file);
    if (!objects.ok()) return objects.status();
    input.objects = std::move(objects.value());
    return input;
}

Result<PlanInput> FromScanFile(const std::string& path) {
    Result<Scanned> scanned = ReadScanFile(path);
    if (!scanned.ok()) return scanned.status();
    return PlanInput{std::move(scanned.value()), {}};
}

}  // namespace

Result<FloorPlan> PlanOfRun(const PlanRequest& request) {
    std::error_code ignored;
    const std::string& path = request.input;
    const bool is_mesh = std::filesystem::path(path).extension() == ".ply";
    Result<PlanInput> input = is_mesh ? FromMesh(path, request.up)
                              : std::filesystem::is_directory(path, ignored) ? FromFolder(path)
                                                                             : FromScanFile(path);
    if (!input.ok()) return input.status();
    if (!is_mesh && !request.up.empty()) {
        const Result<StampedPose> pose = UprightCamera(request.up);
        if (!pose.ok()) return pose.status();
        input.value().scanned.path = {pose.value()};
    }
    Result<FloorPlan> plan =
        MakeFloorPlan(input.value().scanned.mesh, input.value().scanned.path, request.options);
    if (!plan.ok()) return Status::Error(path + ": " + plan.message() + " (which way is up: --up)");
    AddObjects(input.value().objects, plan.value());
    return plan;
}

}  // namespace tessera
