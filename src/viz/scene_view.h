// The 3D view: draws mesh, paths and the sensor's outline into a picture. Made, used and destroyed
// with the OpenGL context current.
#pragma once

#include <memory>
#include <optional>

#include "core/status.h"
#include "viz/coverage.h"
#include "viz/gl_lines.h"
#include "viz/measure_lines.h"
#include "viz/mesh_program.h"
#include "viz/object_boxes.h"
#include "viz/path_lines.h"
#include "viz/scene_mesh.h"
#include "viz/scene_target.h"
#include "viz/view_camera.h"
#include "viz/viewer_state.h"

namespace tessera {

class SceneView {
  public:
    // `levels`: of the coverage.
    static Result<std::unique_ptr<SceneView>> Create(bool is_software,
                                                     const CoverageLevels& levels);

    // Shows a model instead of the link's meshes.
    void SetModel(const ViewedModel& model);
    // Takes mesh updates from the link and uploads about `most_bytes` of them at most; the rest
    // stays queued. True if anything arrived.
    bool TakeMesh(ViewerLink& link, std::size_t most_bytes);
    // The link's run has ended, and all of its mesh is here.
    bool has_final_mesh() const { return mesh_.is_final(); }
    // Moves the camera behind the sensor if following is on. True if it moved.
    bool Follow(const ViewerState& state, double since_s);
    // Moves the camera so that all of the mesh is visible, or of the part of the scan where the
    // sensor was last, keeping the direction.
    void ViewAll(const ViewerState& state);

    // Draws if anything differs from the last picture. Changes by the user (`by_hand`, a choice,
    // the size) are drawn at once, changes by the system only if `may_redraw`. True if it drew.
    struct Request {
        int width = 0, height = 0;  // pixels
        bool may_redraw = true, by_hand = false, smooth = false;
    };
    bool Draw(const ViewerState& state, const Request& request);
    unsigned texture() const { return target_.texture(); }

    ViewCamera& camera() { return camera_; }
    // Returns the surface point at a pixel of the picture, world frame.
    std::optional<Eigen::Vector3d> PointAt(int x, int y) const;
    // Projects a world point into the picture, ignoring occlusion. Returns pixel coordinates and
    // depth in metres; empty if the point is behind the camera.
    std::optional<Eigen::Vector3d> PixelOf(const Eigen::Vector3d& p_world) const;
    std::size_t triangles() const { return mesh_.triangles(); }
    const Coverage& coverage() const { return mesh_.coverage(); }  // of the meshes from the link

  private:
    struct Drawn {
        Eigen::Isometry3d T_world_view = Eigen::Isometry3d::Identity();
        ViewChoices choices;
        Shading shading = Shading::kColour;
        Request request;
    };

    SceneView(MeshProgram program, GlLineProgram lines, bool is_software,
              const CoverageLevels& levels)
        : is_software_(is_software),
          program_(std::move(program)),
          lines_(std::move(lines)),
          levels_(levels),
          mesh_(levels) {}
    void StandUpright();
    bool ChoicesChanged(const ViewerState& state, const Request& request) const;
    void DrawMesh(const ViewerState& state, const PinholeCamera& pinhole);
    void DrawDepth(const ViewerState& state, const PinholeCamera& pinhole);
    void DrawPaths(const ViewerState& state, const PinholeCamera& pinhole);

    bool is_software_;
    MeshProgram program_;
    GlLineProgram lines_;
    const CoverageLevels levels_;
    SceneMesh mesh_;
    PathLines paths_;
    ObjectBoxes boxes_;
    MeasureLines measurements_;
    SceneTarget target_;
    ViewCamera camera_;
    bool followed_ = false, changed_ = true;
    Drawn drawn_;
};

}  // namespace tessera
