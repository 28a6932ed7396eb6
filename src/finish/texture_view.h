// A frame as a source of texture: what it shows of a point of the surface, and how well.
#pragma once

#include <Eigen/Geometry>

#include "core/camera.h"
#include "core/frame.h"
#include "core/frame_motion.h"
#include "core/mesh.h"

namespace tessera {

// 0 to 255.
inline Eigen::Array3f ToArray(const Rgb8& c) { return Eigen::Array3f(c.r, c.g, c.b); }

struct TextureView {
    PinholeCamera camera;
    float fx = 0, fy = 0, cx = 0, cy = 0;  // the camera's, in single precision
    Eigen::Isometry3f T_camera_world = Eigen::Isometry3f::Identity();
    Eigen::Vector3f centre_world = Eigen::Vector3f::Zero();  // the camera's
    // FrameMotion, in single precision.
    Eigen::Vector3f turning_per_s = Eigen::Vector3f::Zero(), moving_per_s = Eigen::Vector3f::Zero();
    float depth_readout_s = 0, colour_delay_s = 0, colour_readout_s = 0;
    ColourImage colour;
    DepthImage depth_m;
    float farthest_m = 0;  // at which the view may show something
    // 0 to 1: falls towards jumps and holes of the depth, where depth and colour may be out of
    // register.
    Image<float> trust;
    Eigen::Array3f gain = Eigen::Array3f::Ones();  // the model's colours / this frame's
    float blur_px = 0;                             // length of the motion blur
};

struct SeenColour {
    float weight = 0;                             // 0: this view does not show the point
    Eigen::Array3f rgb = Eigen::Array3f::Zero();  // 0 to 255, before the gain
};

// The frame must have colour, depth and T_world_camera, which is where the camera was at stamp_s.
// Thread-safe.
TextureView MakeTextureView(const PinholeCamera& camera, const Frame& frame,
                            const FrameMotion& motion);

// What the view shows of the surface point p_world with normal n_world (unit). It does if the
// frame's own depth there is the point's, within the noise of a depth camera: so neither what hides
// the point nor who walks by gets onto it. Depth and colour are looked up where the moving camera
// saw the point when it took their rows, to first order in time. The weight is the number of pixels
// per area of the surface, less by the blur, times the cosine of the angle from which it is seen,
// times the trust, all cubed: sharper views win, and the colour has no steps where one takes over
// from another. Saturated pixels have a tenth of the trust. Thread-safe.
SeenColour See(const TextureView& view, const Eigen::Vector3f& p_world,
               const Eigen::Vector3f& n_world);

// Sets the gain: the median, per channel, of a mesh vertex's colour over that which the view shows
// of it. It removes most of automatic exposure and white balance. 1 if the view shows fewer than
// 100 of the vertices. `mesh` has normals and colours. Thread-safe for distinct views.
void EstimateGain(const TriangleMesh& mesh, TextureView& view);

// Mean difference of neighbouring pixels' luma: falls with blur, for images of the same place.
double Sharpness(const ColourImage& image);

}  // namespace tessera
