// A scene: objects with classes and instances, and their exact geometry and colour behind one
// interface, be they analytic bodies (analytic_scene.h) or a textured triangle mesh (mesh_scene.h).
// Immutable once built: every const member is thread-safe.
//
// World frame: metres, right-handed, z up in the built-in scenes; a model keeps its own axes.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/camera.h"
#include "core/mesh.h"
#include "synth/texture.h"

namespace tessera {

// What a ray met. `t` is in units of the ray's direction: along the optical axis for the rays of a
// ViewCaster.
struct SurfaceHit {
    double t = std::numeric_limits<double>::infinity();
    std::int32_t part = -1;   // shape or triangle, the scene's own count; -1 = nothing was hit
    std::int32_t chart = 0;   // analytic shapes: the part of the surface (shape.h)
    float u = 0, v = 0;       // analytic shapes: chart coordinates, metres; meshes: barycentric
    float cos_incidence = 0;  // |cos| of the angle between ray and surface normal

    bool valid() const { return part >= 0; }
};

// One thing that a person would name. Instance 0 and class 0 are the unlabelled surroundings.
struct SceneInstance {
    std::string name;  // "cup 1"
    int class_id = 0;  // index into Scene::class_names()
};

// Whether a surface moves. The values are the grey levels of a written mask.
enum class Mobility : std::uint8_t { kStatic = 0, kResting = 128, kMoving = 255 };

// A rectangle of pixels; the last ones are excluded.
struct PixelRect {
    int x_begin, y_begin, x_end, y_end;
    int width() const { return x_end - x_begin; }
    int height() const { return y_end - y_begin; }
};

// The rays of one pinhole camera at one place. Thread-safe.
class ViewCaster {
  public:
    virtual ~ViewCaster() = default;
    // The nearest surface through each pixel of `rect`, row by row, `t` being the depth along the
    // optical axis in metres. The rays pass (offset_x, offset_y) pixels beside the pixels' centres.
    // hits.size() is the rect's area.
    virtual void Cast(const PixelRect& rect, double offset_x_px, double offset_y_px,
                      std::span<SurfaceHit> hits) const = 0;
};

class Scene {
  public:
    virtual ~Scene() = default;

    // The caster refers to the scene, as it is so many seconds after its start.
    virtual std::unique_ptr<ViewCaster> View(const PinholeCamera& camera,
                                             const Eigen::Isometry3d& T_world_camera,
                                             double time_s) const = 0;
    // Whether a hit is on a thing that moves at some time, or at this one.
    virtual Mobility MobilityOf(const SurfaceHit&, double /*time_s*/) const {
        return Mobility::kStatic;
    }
    virtual bool has_motion() const { return false; }
    // The nearest static surface along any ray; t in units of the direction's length.
    virtual SurfaceHit CastRay(const Eigen::Vector3d& origin,
                               const Eigen::Vector3d& direction) const = 0;
    // Outward unit normal at a hit.
    virtual Eigen::Vector3d Normal(const SurfaceHit& hit) const = 0;
    // Lit colour at a hit; `footprint_m` is the extent of the sample on the surface, for filtering.
    virtual RgbF Colour(const SurfaceHit& hit, float footprint_m) const = 0;
    // Index into instances() at a hit.
    virtual int InstanceOf(const SurfaceHit& hit) const = 0;

    // The static surface cut into patches of at most 0.1 m, so that what a camera has seen can be
    // told from the rest. PatchOf a hit on something that moves is -1.
    virtual std::int64_t patch_count() const = 0;
    virtual std::int64_t PatchOf(const SurfaceHit& hit) const = 0;
    // The patches' exact mesh (curved surfaces within 0.5 mm), without normals and colours; with
    // `keep`, one flag a patch, only those. A patch belongs to one instance.
    virtual TriangleMesh PatchMesh(const std::vector<bool>* keep = nullptr) const = 0;
    // The mesh of one instance, of one that moves where it is at the start.
    virtual TriangleMesh InstanceMesh(int instance) const = 0;

    // Distance from a world point to the nearest static surface, metres, negative inside a body.
    // Exact outside bodies and inside where bodies do not overlap. Nothing for meshes, which need
    // not be closed.
    virtual std::optional<double> SignedDistance(const Eigen::Vector3d& p_world) const = 0;

    const std::vector<SceneInstance>& instances() const { return instances_; }
    const std::vector<std::string>& class_names() const { return class_names_; }
    // Axis-aligned bounds of everything that is static, metres.
    const Eigen::AlignedBox3d& bounds() const { return bounds_; }

  protected:
    std::vector<SceneInstance> instances_ = {{"surroundings", 0}};
    std::vector<std::string> class_names_ = {"unlabelled"};
    Eigen::AlignedBox3d bounds_;
};

}  // namespace tessera
