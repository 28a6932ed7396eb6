#include "synth/seen_objects.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <nlohmann/json.hpp>

#include "synth/simulated_detector.h"

namespace tessera {
namespace {

// One word for the lists, in which blanks end a word and # begins a comment.
std::string AsWord(std::string name) {
    std::replace_if(
        name.begin(), name.end(),
        [](char c) { return c == '#' || std::isspace(static_cast<unsigned char>(c)) != 0; }, '_');
    return name;
}

nlohmann::json Rounded(const Eigen::Vector3d& p) {
    const auto to_tenth_mm = [](double v) { return std::round(v * 1e4) / 1e4; };
    return {to_tenth_mm(p.x()), to_tenth_mm(p.y()), to_tenth_mm(p.z())};
}

// Bounds and area centroid.
void Describe(const TriangleMesh& mesh, nlohmann::json& object) {
    Eigen::AlignedBox3d bounds;
    Eigen::Vector3d moment = Eigen::Vector3d::Zero();
    double area = 0;
    for (const auto& [ia, ib, ic] : mesh.triangles) {
        const Eigen::Vector3d a = mesh.vertices[ia].cast<double>(),
                              b = mesh.vertices[ib].cast<double>(),
                              c = mesh.vertices[ic].cast<double>();
        for (const Eigen::Vector3d& p : {a, b, c}) bounds.extend(p);
        const double part = (b - a).cross(c - a).norm();
        moment += part * (a + b + c) / 3;
        area += part;
    }
    object["aabb_min"] = Rounded(bounds.min());
    object["aabb_max"] = Rounded(bounds.max());
    object["centroid"] = Rounded(area > 0 ? Eigen::Vector3d(moment / area) : bounds.center());
}

}  // namespace

SeenObjects::SeenObjects(const Scene& scene, std::uint64_t seed)
    : scene_(scene), seed_(seed), counts_(scene.instances().size()) {}

void SeenObjects::Add(const RenderedView& view, std::int64_t frame, double stamp_s) {
    const std::vector<InstanceBox> boxes = FindInstanceBoxes(view.instance, counts_.size());
    for (std::size_t i = 1; i < boxes.size(); ++i) {
        if (boxes[i].pixels == 0) continue;
        ++counts_[i].frames;
        counts_[i].max_pixels = std::max(counts_[i].max_pixels, boxes[i].pixels);
    }
    for (const SimulatedDetection& d :
         SimulateDetections(scene_, boxes, view.instance.size(), seed_, frame))
        detections_ += fmt::format("{:.6f} {} {:.3f} {} {} {} {}\n", stamp_s,
                                   AsWord(scene_.class_names()[d.class_id]), d.probability,
                                   d.box.x_min, d.box.y_min, d.box.x_max, d.box.y_max);
}

std::string SeenObjects::ClassesText() const {
    std::string text = "# id name (id as in labels/*.png; 0 = unlabelled: the surroundings)\n";
    for (std::size_t i = 1; i < scene_.class_names().size(); ++i)
        text += fmt::format("{} {}\n", i, AsWord(scene_.class_names()[i]));
    return text;
}

std::string SeenObjects::ObjectsJson() const {
    nlohmann::ordered_json objects = nlohmann::ordered_json::array();
    for (std::size_t i = 1; i < counts_.size(); ++i) {
        if (counts_[i].frames == 0) continue;
        const SceneInstance& instance = scene_.instances()[i];
        nlohmann::json geometry;
        Describe(scene_.InstanceMesh(static_cast<int>(i)), geometry);
        objects.push_back({{"instance", i},
                           {"name", instance.name},
                           {"class_id", instance.class_id},
                           {"class", scene_.class_names()[instance.class_id]},
                           {"aabb_min", geometry["aabb_min"]},
                           {"aabb_max", geometry["aabb_max"]},
                           {"centroid", geometry["centroid"]},
                           {"frames_visible", counts_[i].frames},
                           {"max_pixels", counts_[i].max_pixels}});
    }
    // Names in a user's model need not be valid UTF-8.
    return objects.dump(1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

std::string SeenObjects::DetectionsText() const {
    return "# timestamp class probability xmin ymin xmax ymax (inclusive pixels; class names with "
           "_ for blanks and #, see "
           "classes.txt)\n" +
           detections_;
}

}  // namespace tessera
