// A scene that consists of a textured triangle mesh, ray traced with Embree. Const and thread-safe
// once constructed.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "synth/obj_model.h"
#include "synth/scene.h"

namespace tessera {

class MeshScene : public Scene {
  public:
    // Reads the model's textures. Each object of the file is an instance; its class is its name
    // without trailing numbers ("Chair_01_002" -> "chair"). `model` must have triangles (ReadObj
    // checks this).
    explicit MeshScene(ObjModel model);
    ~MeshScene() override;

    std::unique_ptr<ViewCaster> View(const PinholeCamera& camera,
                                     const Eigen::Isometry3d& T_world_camera,
                                     double time_s) const override;
    SurfaceHit CastRay(const Eigen::Vector3d& origin,
                       const Eigen::Vector3d& direction) const override;
    Eigen::Vector3d Normal(const SurfaceHit& hit) const override;
    RgbF Colour(const SurfaceHit& hit, float footprint_m) const override;
    int InstanceOf(const SurfaceHit& hit) const override;
    std::int64_t patch_count() const override { return first_patch_.back(); }
    std::int64_t PatchOf(const SurfaceHit& hit) const override;
    TriangleMesh PatchMesh(const std::vector<bool>* keep) const override;
    TriangleMesh InstanceMesh(int instance) const override;
    std::optional<double> SignedDistance(const Eigen::Vector3d&) const override {
        return std::nullopt;
    }

    // Textures that the model references but that could not be read. Their surfaces have the
    // material's colour.
    const std::vector<std::string>& missing_textures() const { return missing_textures_; }

  private:
    friend class MeshView;
    struct Tracer;  // Embree device and scene

    struct Surface {
        float shade;     // light, as a fraction of full brightness
        float uv_per_m;  // texture coordinates per metre
    };

    void ReadTextures();
    void NameInstances();
    void Tessellate();
    int Divisions(std::size_t triangle) const;
    void AppendTriangle(std::size_t triangle, const std::vector<bool>* keep,
                        TriangleMesh& mesh) const;

    ObjModel model_;
    std::unique_ptr<Tracer> tracer_;
    std::vector<Texture> textures_;          // one per material
    std::vector<Surface> surfaces_;          // one per triangle
    std::vector<std::int64_t> first_patch_;  // one per triangle, then the total
    double patch_m_ = 0.1;
    std::vector<std::string> missing_textures_;
};

}  // namespace tessera
