// How far a reconstructed surface lies from the true one, and how much of the true one it covers:
// distances from vertices to triangles, as CloudCompare's cloud-to-mesh gives (unsigned).
#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "core/mesh.h"
#include "core/status.h"
#include "eval/statistics.h"

namespace tessera {

struct MeshErrorOptions {
    // Applied to the mesh first: Alignment::T_reference_estimate where the worlds differ.
    Eigen::Isometry3d T_reference_mesh = Eigen::Isometry3d::Identity();
    double completeness_distance_m = 0.05;
    int completeness_samples = 100000;  // points on the reference, at least 1
};

struct MeshErrorResult {
    ErrorStatistics accuracy_m;  // from each of the mesh's vertices to the reference's triangles
    std::vector<float> distances_m;  // the same, one per vertex
    // Share of the reference's area that has a point of the mesh within completeness_distance_m.
    double completeness = 0;
};

// A mesh without vertices or a reference without triangles is an error. A mesh without triangles
// counts as its points. Uses all cores (TBB); the same figures for any number. Thread-safe.
Result<MeshErrorResult> MeasureMeshError(const TriangleMesh& mesh, const TriangleMesh& reference,
                                         const MeshErrorOptions& options = {});

// `count` points spread evenly over the triangles' area, always the same ones. Empty if the area
// is 0.
std::vector<Eigen::Vector3d> SampleSurface(const TriangleMesh& mesh, int count);

// The mesh in another frame: vertices moved, normals turned.
TriangleMesh TransformMesh(const TriangleMesh& mesh, const Eigen::Isometry3d& T_target_mesh);

// Blue at 0, over cyan, green in the middle and yellow to red at max_m and beyond.
Rgb8 ErrorColour(double error_m, double max_m);
std::vector<Rgb8> ErrorColours(const std::vector<float>& errors_m, double max_m);

// {"accuracy_mean_m", "accuracy_std_m", "accuracy_max_m", "accuracy_rmse_m", "completeness_5cm",
// "points"}
std::string MeshErrorJson(const MeshErrorResult& result);

}  // namespace tessera
