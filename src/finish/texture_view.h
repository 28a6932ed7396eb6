// A frame as a source of texture: what it shows of a point of the surface, and how well.
#pragma once

#include <Eigen/Geometry>
#include <span>

#include "core/camera.h"
#include "core/frame.h"
#include "core/mesh.h"
#include "core/se3.h"

namespace tessera {

// 0 to 255.
inline Eigen::Array3f ToArray(const Rgb8& c) { return Eigen::Array3f(c.r, c.g, c.b); }

struct TextureView {
    PinholeCamera camera;
    Eigen::Isometry3f T_camera_world = Eigen::Isometry3f::Identity();
    ColourImage colour;
    DepthImage depth_m;
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

// The frame must have colour, depth and T_world_camera. Thread-safe.
TextureView MakeTextureView(const PinholeCamera& camera, const Frame& frame);

// What the view shows of the surface point p_world with normal n_world (unit). It does if the
// frame's own depth there is the point's, within the noise of a depth camera: so neither what hides
// the point nor who walks by gets onto it. The weight is the number of pixels per area of the
// surface, less by the blur, times the cosine of the angle from which it is seen, times the trust,
// all cubed: sharper views win, and the colour has no steps where one takes over from another.
// Saturated pixels have a tenth of the trust. Thread-safe.
SeenColour See(const TextureView& view, const Eigen::Vector3f& p_world,
               const Eigen::Vector3f& n_world);

// Length of the blur of a frame at `stamp_s`, pixels, from how fast the camera turned there and an
// exposure of a sixtieth of a second. 0 where the path has no neighbours within 0.2 s. Thread-safe.
float MotionBlur_px(std::span<const StampedPose> path, double stamp_s, const PinholeCamera& camera);

// Sets the gain: the median, per channel, of a mesh vertex's colour over that which the view shows
// of it. It removes most of automatic exposure and white balance. 1 if the view shows fewer than
// 100 of the vertices. `mesh` has normals and colours. Thread-safe for distinct views.
void EstimateGain(const TriangleMesh& mesh, TextureView& view);

// Mean difference of neighbouring pixels' luma: falls with blur, for images of the same place.
double Sharpness(const ColourImage& image);

}  // namespace tessera
