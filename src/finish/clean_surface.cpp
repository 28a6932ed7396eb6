#include "finish/clean_surface.h"

#include <algorithm>
#include <cmath>

#include "core/depth_noise.h"
#include "finish/mesh_edges.h"
#include "finish/nearest_depth.h"
#include "finish/noise_factor.h"
#include "finish/smooth.h"

namespace tessera {
namespace {

std::vector<int> RoundsOf(const std::vector<float>& sigmas_m, int rounds) {
    std::vector<int> of_vertex;
    of_vertex.reserve(sigmas_m.size());
    for (const float sigma_m : sigmas_m)
        of_vertex.push_back(
            static_cast<int>(std::lround(NoiseFactor(sigma_m) * static_cast<float>(rounds))));
    return of_vertex;
}

// Standard deviations of the depth at the vertices from `first` on.
void AddSigmas(const TriangleMesh& mesh, std::size_t first, const PinholeCamera& camera,
               std::span<const StampedPose> path, std::vector<float>& sigmas_m) {
    TriangleMesh points;
    points.vertices.assign(mesh.vertices.begin() + static_cast<std::ptrdiff_t>(first),
                           mesh.vertices.end());
    for (const float depth_m : NearestDepths_m(points, camera, path))
        sigmas_m.push_back(DepthSigma_m(depth_m));
}

}  // namespace

CleanSurface Clean(TriangleMesh mesh, const PinholeCamera& camera,
                   std::span<const StampedPose> path, const FrameEvidence& evidence,
                   const CleanOptions& options, FinishReport& report) {
    CleanSurface surface;
    surface.mesh = std::move(mesh);
    if (options.remove_flaps) report.flaps = RemoveFlaps(surface.mesh, evidence);
    AddSigmas(surface.mesh, 0, camera, path, surface.sigmas_m);
    report.islands = RemoveIslands(surface.mesh, options.least_island_m2, surface.sigmas_m);
    Smooth(surface.mesh, RoundsOf(surface.sigmas_m, options.smoothing_rounds));
    surface.first_filled = surface.mesh.triangles.size();
    if (options.hole_m > 0) {
        const std::size_t measured = surface.mesh.vertices.size();
        report.holes = CloseHoles(surface.mesh, options.hole_m, evidence);
        AddSigmas(surface.mesh, measured, camera, path, surface.sigmas_m);
    }
    return surface;
}

TriangleMesh FilledPart(const CleanSurface& surface) {
    TriangleMesh filled = surface.mesh;
    filled.triangles.erase(
        filled.triangles.begin(),
        filled.triangles.begin() + static_cast<std::ptrdiff_t>(surface.first_filled));
    DropUnusedVertices(filled);
    return filled;
}

}  // namespace tessera
