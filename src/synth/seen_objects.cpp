#include "synth/seen_objects.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "synth/hash_random.h"

namespace tessera {
namespace {

constexpr std::uint64_t kDetectorStream = 5;
constexpr double kMissed = 0.10, kWrongClass = 0.03;
constexpr double kProbability = 0.9, kProbabilityStd = 0.06;
constexpr double kLeastShare = 400.0 / (640.0 * 480.0);  // of the image

std::string WithoutBlanks(std::string name) {
    std::replace(name.begin(), name.end(), ' ', '_');
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

std::vector<SeenObjects::Box> SeenObjects::BoxesOf(const RenderedView& view) const {
    const int width = view.instance.width(), height = view.instance.height();
    std::vector<Box> boxes(counts_.size(), Box{width, height, -1, -1, 0});
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            Box& box = boxes[view.instance(x, y)];
            box.x_min = std::min(box.x_min, x);
            box.y_min = std::min(box.y_min, y);
            box.x_max = std::max(box.x_max, x);
            box.y_max = std::max(box.y_max, y);
            ++box.pixels;
        }
    }
    return boxes;
}

void SeenObjects::Add(const RenderedView& view, std::int64_t frame, double stamp_s) {
    const std::vector<Box> boxes = BoxesOf(view);
    const double least = kLeastShare * static_cast<double>(view.instance.size());
    for (std::size_t i = 1; i < boxes.size(); ++i) {
        if (boxes[i].pixels == 0) continue;
        ++counts_[i].frames;
        counts_[i].max_pixels = std::max(counts_[i].max_pixels, boxes[i].pixels);
        if (static_cast<double>(boxes[i].pixels) > least)
            Detect(static_cast<int>(i), boxes[i], frame, stamp_s);
    }
}

void SeenObjects::Detect(int instance, const Box& box, std::int64_t frame, double stamp_s) {
    std::uint64_t counter = StreamKey(seed_, kDetectorStream, static_cast<std::uint64_t>(frame)) +
                            4 * static_cast<std::uint64_t>(instance);
    if (UniformFromBits(MixBits(counter++)) < kMissed) return;
    int class_id = scene_.instances()[instance].class_id;
    const int class_count =
        static_cast<int>(scene_.class_names().size()) - 1;  // without "unlabelled"
    if (UniformFromBits(MixBits(counter++)) < kWrongClass && class_count > 1) {
        const int step =
            1 + static_cast<int>(UniformFromBits(MixBits(counter)) * (class_count - 1));
        class_id = 1 + (class_id - 1 + step) % class_count;
    }
    ++counter;
    const double p = std::clamp(kProbability + kProbabilityStd * GaussianFromBits(MixBits(counter)),
                                0.05, 0.999);
    detections_ += fmt::format("{:.6f} {} {:.3f} {} {} {} {}\n", stamp_s,
                               WithoutBlanks(scene_.class_names()[class_id]), p, box.x_min,
                               box.y_min, box.x_max, box.y_max);
}

std::string SeenObjects::ClassesText() const {
    std::string text = "# id name (id as in labels/*.png; 0 = unlabelled: the surroundings)\n";
    for (std::size_t i = 1; i < scene_.class_names().size(); ++i)
        text += fmt::format("{} {}\n", i, WithoutBlanks(scene_.class_names()[i]));
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
    // A model's names are a user's bytes and need not be UTF-8.
    return objects.dump(1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

std::string SeenObjects::DetectionsText() const {
    return "# timestamp class probability xmin ymin xmax ymax (inclusive pixels; class names with "
           "_ for blanks, see "
           "classes.txt)\n" +
           detections_;
}

}  // namespace tessera
