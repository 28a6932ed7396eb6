// One level of detail on its way to a textured model: a mesh laid out in an atlas, and the texture
// that is being baked.
#pragma once

#include <span>

#include "core/se3.h"
#include "finish/finish_report.h"
#include "finish/texture_baker.h"
#include "io/textured_mesh.h"

namespace tessera {

struct LevelOptions {
    double texel_m = 0.002;   // on the surface; made larger until the texture fits
    int texture_side = 4096;  // texels
};

// Owner thread only.
class TexturedLevel {
  public:
    // Cuts the mesh, which has normals and colours, into charts. Texels are as wide as the nearest
    // view's pixels where that is more than the option. Fills the report's charts and texel. An
    // error if the surface is in too many pieces for a texture.
    static Result<TexturedLevel> Make(TriangleMesh mesh, const PinholeCamera& camera,
                                      std::span<const StampedPose> path,
                                      const LevelOptions& options, LevelReport& report);

    void Add(const TextureView& view) { baker_.Add(view); }
    // A vertex for each chart that a vertex of the mesh lies in. Fills the rest of the report.
    TexturedMesh Finish(LevelReport& report) const;

  private:
    TexturedLevel(TriangleMesh mesh, std::vector<Chart> charts, Atlas atlas)
        : mesh_(std::move(mesh)),
          charts_(std::move(charts)),
          atlas_(std::move(atlas)),
          baker_(mesh_, charts_, atlas_) {}

    TriangleMesh mesh_;
    std::vector<Chart> charts_;
    Atlas atlas_;
    TextureBaker baker_;
};

}  // namespace tessera
