// A keyframe's depth and intensity at reduced resolution: what direct alignment with other
// keyframes compares.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "core/camera.h"
#include "core/frame_motion.h"
#include "core/image.h"
#include "mapping/prepared_frame.h"

namespace tessera {

// What a keyframe keeps: about 160 columns, 3 bytes a pixel.
struct ReducedView {
    static constexpr int kColumns = 160;
    static constexpr float kUnitsPerM = 4000;  // of depth

    int reduction = 1;           // a pixel here averages n x n pixels of the frame
    Image<std::uint16_t> depth;  // 0 where a pixel has no clear depth
    Image<std::uint8_t> luma;    // empty without colour

    bool empty() const { return depth.empty(); }
};

// `camera`: of the frame. Each depth gets the intensity of its own surface, whose place in the
// colour image follows from `motion`; where that is outside the image, there is no depth.
// Thread-safe.
ReducedView MakeReducedView(const PreparedFrame& frame, const PinholeCamera& camera,
                            const FrameMotion& motion);

// A point of a view, with its surface normal and its intensity.
struct ViewPoint {
    Eigen::Vector3f p_camera;  // metres
    Eigen::Vector3f normal;    // unit, towards the camera
    float intensity = -1;      // [0, 1]; -1 without colour
    float sigma_m = 0;         // standard deviation of the depth
};

struct DenseView {
    static constexpr int kLevels = 3;

    struct Level {
        PinholeCamera camera;
        DepthImage depth_m;             // 0 where missing
        Image<float> intensity;         // [0, 1]; -1 where missing
        Image<Eigen::Vector3f> normal;  // zero where there is none
        std::vector<ViewPoint> points;  // pixels with a normal; on the finest level every fourth
    };

    std::array<Level, kLevels> levels;  // coarse to fine; the finest has the size of ReducedView

    bool empty() const { return levels.back().points.empty(); }
};

// `camera`: of the frame at full resolution. Thread-safe.
DenseView MakeDenseView(const ReducedView& view, const PinholeCamera& camera);

}  // namespace tessera
