#include "semantics/objects_file.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "core/input_file.h"

namespace tessera {
namespace {

using Json = nlohmann::json;

Eigen::Vector3d ToVector(const Json& json) {
    return Eigen::Vector3d(json.at(0).get<double>(), json.at(1).get<double>(),
                           json.at(2).get<double>());
}

// The library converts a number beyond the range of int without a check.
int ToInt(const Json& json) {
    const double value = json.get<double>();
    if (value != std::trunc(value) || std::abs(value) > std::numeric_limits<int>::max())
        throw std::out_of_range(fmt::format("{} is not a whole number", value));
    return static_cast<int>(value);
}

// Throws a JSON exception if a field is missing or has the wrong type.
MapObject ToObject(const Json& json) {
    MapObject o;
    o.id = ToInt(json.at("id"));
    o.class_id = ToInt(json.at("class_id"));
    o.class_name = json.at("class");
    const std::string colour = json.at("colour");
    const unsigned long rgb =
        std::stoul(colour.substr(std::min<std::size_t>(1, colour.size())), nullptr, 16);
    o.colour = {static_cast<std::uint8_t>(rgb >> 16), static_cast<std::uint8_t>(rgb >> 8),
                static_cast<std::uint8_t>(rgb)};
    o.probability = json.at("probability");
    o.observations = ToInt(json.at("observations"));
    if (json.contains("vertices")) o.vertices = ToInt(json.at("vertices"));
    o.centroid = ToVector(json.at("centroid"));
    o.box = Eigen::AlignedBox3d(ToVector(json.at("aabb_min")), ToVector(json.at("aabb_max")));
    o.oriented_size = ToVector(json.at("obb_size"));
    const Json& q = json.at("obb_quaternion_xyzw");
    o.T_world_oriented.translation() = ToVector(json.at("obb_centre"));
    o.T_world_oriented.linear() = Eigen::Quaterniond(q.at(3).get<double>(), q.at(0).get<double>(),
                                                     q.at(1).get<double>(), q.at(2).get<double>())
                                      .normalized()
                                      .toRotationMatrix();
    if (json.contains("embedding")) o.embedding = json.at("embedding").get<std::vector<float>>();
    return o;
}

}  // namespace

Rgb8 NoCategoryColour(const Rgb8& scene) {
    const double luma = 0.299 * scene.r + 0.587 * scene.g + 0.114 * scene.b;
    const auto grey = static_cast<std::uint8_t>(std::lround(70 + 0.55 * luma));
    return {grey, grey, grey};
}

Result<std::vector<MapObject>> ReadObjects(const std::string& path) {
    const Result<std::string> text = ReadWholeFile(path, std::size_t{1} << 28);
    if (!text.ok()) return text.status();
    const Json json = Json::parse(text.value(), nullptr, false);
    if (!json.is_array()) return Status::Error(path + ": not a list of objects");
    std::vector<MapObject> objects;
    try {
        for (const Json& object : json) objects.push_back(ToObject(object));
    } catch (const std::exception& error) {
        return Status::Error(
            fmt::format("{}: object {}: {}", path, objects.size(), Printable(error.what(), 200)));
    }
    return objects;
}

std::vector<Rgb8> CategoryColours(const TriangleMesh& labelled,
                                  const std::vector<MapObject>& objects) {
    std::map<int, Rgb8> of_class;
    for (const MapObject& o : objects) of_class[o.class_id] = o.colour;
    std::vector<Rgb8> colours(labelled.vertices.size(), kNoSceneColour);
    for (std::size_t i = 0; i < colours.size(); ++i) {
        const int class_id = i < labelled.labels.size() ? labelled.labels[i].class_id : 0;
        if (class_id != 0)
            colours[i] = of_class.try_emplace(class_id, DistinctColour(class_id)).first->second;
        else if (!labelled.colours.empty())
            colours[i] = NoCategoryColour(labelled.colours[i]);
    }
    return colours;
}

TriangleMesh ExtractInstance(const TriangleMesh& labelled, int id) {
    constexpr std::uint32_t kUnused = std::numeric_limits<std::uint32_t>::max();
    std::vector<std::uint32_t> new_index(labelled.vertices.size(), kUnused);
    TriangleMesh part;
    const auto take = [&](std::uint32_t v) {
        if (new_index[v] != kUnused) return new_index[v];
        new_index[v] = static_cast<std::uint32_t>(part.vertices.size());
        part.vertices.push_back(labelled.vertices[v]);
        if (!labelled.normals.empty()) part.normals.push_back(labelled.normals[v]);
        if (!labelled.colours.empty()) part.colours.push_back(labelled.colours[v]);
        part.labels.push_back(labelled.labels[v]);
        return new_index[v];
    };
    const auto is_its = [&](std::uint32_t v) {
        return v < labelled.labels.size() && labelled.labels[v].instance == id;
    };
    for (const auto& [a, b, c] : labelled.triangles)
        if (is_its(a) && is_its(b) && is_its(c))
            part.triangles.push_back({take(a), take(b), take(c)});
    return part;
}

}  // namespace tessera
