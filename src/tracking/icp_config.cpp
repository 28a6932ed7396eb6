#include "tracking/icp_tracker.h"

namespace tessera {

void IcpTracker::Config::Describe(ConfigParameters& p) {
    p.AddChoice("prediction", prediction,
                {{"raycast", Prediction::kRayCast}, {"raster", Prediction::kRaster}},
                "source of the predicted view: ray casting of the field, or its mesh drawn by "
                "OpenGL ([D18]); without OpenGL the ray caster is used instead");
    p.Add("finest_step_px", finest_step_px, {0, 16}, "px",
          "pixel step of the finest level, in both directions, in the frame and in the predicted "
          "view; 0: 2 at 640 x 480, and in proportion at larger sizes; [D18] uses 1");
    p.Add(
        "levels", levels, {1, 5}, "",
        "number of pyramid levels; each coarser level halves the images; fewer where the coarsest "
        "would have less than 6 pixels on a side");
    p.Add("coarse_iterations", coarse_iterations, {1, 100}, "",
          "maximum number of Levenberg-Marquardt steps on the coarsest level");
    p.Add("middle_iterations", middle_iterations, {1, 100}, "",
          "maximum number of steps on each level in between");
    p.Add("fine_iterations", fine_iterations, {1, 100}, "",
          "maximum number of steps on the finest level");
    p.Add("distance_gate_m", distance_gate_m, {1e-3, 10.0}, "m",
          "associations of points farther apart than this are rejected");
    p.Add("normal_gate_rad", normal_gate_rad, {0.01, 1.57}, "rad",
          "associations whose normals differ by more than this are rejected");
    p.Add("normal_radius_px", normal_radius_px, {0, 32}, "px",
          "normals of the measured surface come from differences across this many pixels to each "
          "side; 0: from the differences to the next pixel, [D18] eq. 15");
    p.Add("distance_scale_m", distance_scale_m, {1e-4, 10.0}, "m",
          "Huber scale of distances: larger residuals count linearly; a scale above the gate gives "
          "least squares, as in [D18]");
    p.Add("noise_depth_m", noise_depth_m, {0.0, 100.0}, "m",
          "a point's weight is the inverse variance of its distance: nearer than this most of the "
          "error is one of direction, which grows with depth, farther away one of disparity, which "
          "grows with its square; 0: equal weights, [D18]");
}

}  // namespace tessera
