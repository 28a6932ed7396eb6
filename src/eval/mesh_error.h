// Measures how far a reconstructed surface lies from the true surface, and how much of the true
// surface it covers. Distances are from vertices to triangles, unsigned, as in CloudCompare's
// cloud-to-mesh tool.
#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "core/mesh.h"
#include "core/status.h"
#include "eval/statistics.h"

namespace tessera {

struct MeshErrorOptions {
    // Applied to the mesh first. Use Alignment::T_reference_estimate if the worlds differ.
    Eigen::Isometry3d T_reference_mesh = Eigen::Isometry3d::Identity();
    double completeness_distance_m = 0.05;
    int completeness_samples = 100000;  // points on the reference, at least 1
};

struct MeshErrorResult {
    ErrorStatistics accuracy_m;      // from each vertex of the mesh to the reference's triangles
    std::vector<float> distances_m;  // the same, one per vertex
    // Share of the reference's area that lies within completeness_distance_m of the mesh.
    double completeness = 0;
};

// A mesh without vertices or a reference without triangles is an error. A mesh without triangles is
// treated as a point cloud. Uses all cores (TBB); the result does not depend on their number.
// Thread-safe.
Result<MeshErrorResult> MeasureMeshError(const TriangleMesh& mesh, const TriangleMesh& reference,
                                         const MeshErrorOptions& options = {});

// `count` points, evenly distributed over the area of the triangles. Deterministic. Empty if the
// area is 0.
std::vector<Eigen::Vector3d> SampleSurface(const TriangleMesh& mesh, int count);

// Transforms vertices and normals into another frame.
TriangleMesh TransformMesh(const TriangleMesh& mesh, const Eigen::Isometry3d& T_target_mesh);

// Blue at 0, then cyan, green in the middle, yellow, and red at max_m and above.
Rgb8 ErrorColour(double error_m, double max_m);
std::vector<Rgb8> ErrorColours(const std::vector<float>& errors_m, double max_m);

// {"accuracy_mean_m", "accuracy_std_m", "accuracy_max_m", "accuracy_rmse_m", "completeness_5cm",
// "points"}
std::string MeshErrorJson(const MeshErrorResult& result);

}  // namespace tessera
