// The truth of a sequence's labels: class and instance images, with poses. Used by
// label_scores.cpp.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "core/camera.h"
#include "core/mesh.h"
#include "core/se3.h"

namespace tessera {

struct LabelTruth {
    std::string folder;
    PinholeCamera camera;
    double depth_scale = 5000;
    std::vector<StampedPose> poses;  // T_world_camera
    // One a pose; names only, the same in labels/ and instances/.
    std::vector<std::string> depth_files;
    std::map<int, std::string> class_names;
    std::map<int, int> class_of_instance;  // filled as images are read
};

// Errors name the file that is missing or wrong.
Result<LabelTruth> ReadLabelTruth(const std::string& folder);

struct TruthImages {
    DepthImage depth_m;
    Image<std::uint16_t> class_id, instance;
};
Status ReadTruthImages(const LabelTruth& truth, std::size_t frame, TruthImages& images);

// Each vertex's most frequent truth over every `stride`-th frame; VertexLabel{} with `seen` 0 where
// none saw it. `mesh` is in the truth's world.
Status LookUpVertices(LabelTruth& truth, const TriangleMesh& mesh, std::size_t stride,
                      std::vector<VertexLabel>& labels, std::vector<std::uint8_t>& seen);

}  // namespace tessera
