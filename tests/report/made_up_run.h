// The files of a small run, as tessera run writes them.
#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "core/se3.h"
#include "io/file.h"
#include "io/mesh_io.h"
#include "io/trajectory.h"
#include "report/made_up_mesh.h"

namespace tessera {

inline constexpr const char* kFramesHeader =
    "index,stamp_s,method,status,fused,degenerate,inlier_fraction,prepare_ms,track_ms,moving_ms,"
    "allocate_ms,fuse_ms,frame_ms,reason\n";
inline constexpr const char* kHostile = "</script><script>alert(1)</script>\"'&<b>";

// Frame n is at 100 s + n / 10 s.
inline std::string FrameLine(int n, const char* status, int fused, const std::string& reason) {
    return fmt::format("{},{:.6f},sdf,{},{},0,0.9,1.5,20.5,1,1,10,50,\"{}\"\n", n, 100 + 0.1 * n,
                       status, fused, reason);
}

inline std::vector<StampedPose> MadeUpPath(double bend_m) {
    std::vector<StampedPose> path(30);
    for (int i = 0; i < 30; ++i) {
        path[i].stamp_s = 100 + 0.1 * i;
        path[i].T_world_camera.translation() =
            Eigen::Vector3d(0.05 * i, 0.3 * std::sin(0.2 * i), 2 + bend_m * std::sin(0.5 * i));
    }
    return path;
}

// Everything that a run can have, with hostile names. `folder` exists.
inline void WriteMadeUpRun(const std::string& folder, const std::string& name = kHostile) {
    std::string quoted;
    for (const char c : name) quoted += c == '"' ? std::string("\\\"") : std::string(1, c);
    std::string frames = kFramesHeader;
    for (int i = 0; i < 30; ++i)
        frames += FrameLine(i, i == 12 ? "lost" : "good", i != 12, i == 12 ? "<b>no view</b>" : "");
    const std::string run = fmt::format(
        R"({{"version": "9.9", "command_line": ["/usr/bin/tessera", "run", "{0}"],
            "exit": "finished", "source": {{"name": "{0}", "kind": "made up", "has_truth": true,
            "camera": {{"width": 640, "height": 480, "fx": 525, "fy": 525}}, "warnings": ["{0}"]}},
            "counts": {{"frames": 30, "tracked": 29}}, "ate": null,
            "configuration": {{"a.number": 1.50, "a.text": "{0}", "a.gone": true}}}})",
        quoted);
    const std::string objects = fmt::format(
        R"([{{"id": 3, "class": "{}", "class_id": 7, "colour": "#102030", "probability": 0.9,
            "observations": 5, "vertices": 10, "centroid": [0, 4, 0], "aabb_min": [0, 3, 0],
            "aabb_max": [1, 5, 1], "obb_centre": [1, 4, 0], "obb_size": [1, 2, 0.5],
            "obb_quaternion_xyzw": [0, 0, 0, 1]}}])",
        quoted);
    const std::string times =
        R"({"wall_s": 3, "fps": 10, "peak_rss_mb": 100, "map": {"bytes": 1000000},
            "stages": {"frame": {"mean_ms": 50, "median_ms": 49, "p95_ms": 60, "max_ms": 70}}})";
    for (const Status& status :
         {WritePly(folder + "/mesh.ply", BumpySheet(20, true)),
          WriteTrajectory(folder + "/trajectory.txt", MadeUpPath(0.1)),
          WriteTrajectory(folder + "/trajectory_tracked.txt", MadeUpPath(0.2)),
          WriteTrajectory(folder + "/groundtruth.txt", MadeUpPath(0.11)),
          WriteTextFile(folder + "/frames.csv", frames), WriteTextFile(folder + "/run.json", run),
          WriteTextFile(folder + "/objects.json", objects),
          WriteTextFile(folder + "/timings.json", times)})
        ASSERT_TRUE(status.ok()) << status.message();
}

}  // namespace tessera
