// Ground-truth labels of a sequence: class and instance images, with poses. Used by label_run.cpp,
// label_scores.cpp and detection_run.cpp.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "core/camera.h"
#include "core/mesh.h"
#include "core/se3.h"
#include "core/status.h"
#include "eval/detection_scores.h"

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

// Renames the truth's classes.
void Rename(const ClassAliases& aliases, LabelTruth& truth);

// The image's objects of named classes, by instance. Those of up to 400 pixels (of 640x480; more or
// fewer for other sizes) do not count.
std::vector<TrueObject> ObjectsOf(const LabelTruth& truth, const TruthImages& images);

// Pairs the images that the detector looked at (within 2 ms; all if `rows.frames` is empty) with
// its detections. Errors name the image or, with `path`, the detections.
Result<std::vector<ScoredImage>> PairWithTruth(const LabelTruth& truth, const DetectionRows& rows,
                                               const std::string& path);

// Finds each vertex's most frequent label in every `stride`-th frame. If no frame saw a vertex, its
// label is VertexLabel{} and `seen` is 0. `mesh` is in the ground truth's world.
Status LookUpVertices(LabelTruth& truth, const TriangleMesh& mesh, std::size_t stride,
                      std::vector<VertexLabel>& labels, std::vector<std::uint8_t>& seen);

}  // namespace tessera
