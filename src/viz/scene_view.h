// The 3D view: mesh, paths and the sensor's outline, drawn into a picture. Made, used and destroyed
// with the OpenGL context current.
#pragma once

#include <memory>
#include <optional>

#include "core/status.h"
#include "viz/view_camera.h"
#include "viz/viewer_state.h"

namespace tessera {

class SceneView {
  public:
    static Result<std::unique_ptr<SceneView>> Create(bool is_software);
    ~SceneView();

    // In place of a link's meshes.
    void SetModel(const ViewedModel& model);
    // Takes what the link has of the mesh, at most about `most_bytes` onto the card; the rest
    // waits, at last in the mesher. True if anything came.
    bool TakeMesh(ViewerLink& link, std::size_t most_bytes);
    // Moves the camera behind the sensor as the choices say. True if it moved.
    bool Follow(const ViewerState& state, double since_s);
    // So that all of the mesh shows, in the present direction.
    void ViewAll();

    // Draws if anything differs from the last picture; what the person did (`by_hand`, a choice,
    // the size) at once, what the system did only if `may_redraw`. True if it drew.
    struct Request {
        int width = 0, height = 0;  // pixels
        bool may_redraw = true, by_hand = false, smooth = false;
    };
    bool Draw(const ViewerState& state, const Request& request);
    unsigned texture() const;

    ViewCamera& camera();
    // The surface's point at a pixel of the picture, world frame.
    std::optional<Eigen::Vector3d> PointAt(int x, int y) const;
    // The pixel of the picture where a point of the world frame shows, whatever is before it, and
    // its depth in metres; nothing if it is behind the camera.
    std::optional<Eigen::Vector3d> PixelOf(const Eigen::Vector3d& p_world) const;
    std::size_t triangles() const;

  private:
    struct Impl;
    explicit SceneView(std::unique_ptr<Impl> impl);
    std::unique_ptr<Impl> impl_;
};

}  // namespace tessera
