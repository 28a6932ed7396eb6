// Ground-truth labels of a sequence: class and instance images, with poses. Used by label_run.cpp
// and label_scores.cpp.
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
    // One per pose; file names only, the same in depth/, labels/ and instances/.
    std::vector<std::string> depth_files;
    std::map<int, std::string> class_names;
    std::map<int, int> class_of_instance;  // filled in as images are read
};

// Errors name the file that is missing or wrong.
Result<LabelTruth> ReadLabelTruth(const std::string& folder);

struct TruthImages {
    DepthImage depth_m;
    Image<std::uint16_t> class_id, instance;
};
Status ReadTruthImages(const LabelTruth& truth, std::size_t frame, TruthImages& images);

// Finds each vertex's most frequent label in every `stride`-th frame. If no frame saw a vertex, its
// label is VertexLabel{} and `seen` is 0. `mesh` is in the ground truth's world.
Status LookUpVertices(LabelTruth& truth, const TriangleMesh& mesh, std::size_t stride,
                      std::vector<VertexLabel>& labels, std::vector<std::uint8_t>& seen);

}  // namespace tessera
