#include "synth/obj_model.h"

#include <tiny_obj_loader.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <filesystem>
#include <map>
#include <sstream>
#include <utility>

#include "core/input_file.h"

namespace tessera {
namespace {

constexpr float kFarthest = 1e5f;  // metres; beyond it single precision cannot resolve millimetres
constexpr float kLargestUv = 1e4f;
constexpr std::size_t kMaxModelBytes = std::size_t{4} << 30, kMaxMaterialBytes = 16 << 20;

std::uint8_t ToByte(float share) {
    return static_cast<std::uint8_t>(
        std::lround(255.0f * std::clamp(std::isnan(share) ? 0.0f : share, 0.0f, 1.0f)));
}

Status TakeVertices(const std::string& path, const tinyobj::attrib_t& attributes, ObjModel& model) {
    for (std::size_t i = 0; i + 2 < attributes.vertices.size(); i += 3) {
        const Eigen::Vector3f p(attributes.vertices[i], attributes.vertices[i + 1],
                                attributes.vertices[i + 2]);
        if (!(p.cwiseAbs().maxCoeff() < kFarthest) || !p.allFinite())
            return Status::Error(
                fmt::format("{}: vertex {} at ({}, {}, {}) is too far from the origin or not "
                            "finite; check the model's units (metres)",
                            path, i / 3 + 1, p.x(), p.y(), p.z()));
        model.vertices.push_back(p);
    }
    return Status::Ok();
}

void TakeMaterials(const std::string& folder, const std::vector<tinyobj::material_t>& materials,
                   ObjModel& model) {
    for (const tinyobj::material_t& m : materials) {
        ObjModel::Material material;
        material.colour = {ToByte(m.diffuse[0]), ToByte(m.diffuse[1]), ToByte(m.diffuse[2])};
        if (!m.diffuse_texname.empty()) {
            std::string name = m.diffuse_texname;
            std::replace(name.begin(), name.end(), '\\', '/');
            material.texture_path = folder + name;
        }
        model.materials.push_back(material);
    }
    model.materials.emplace_back();
}

// Splits one polygon into a fan of triangles.
Status TakePolygon(const std::string& path, const tinyobj::attrib_t& attributes,
                   const tinyobj::index_t* corners, std::size_t count, ObjModel::Triangle triangle,
                   ObjModel& model) {
    const auto take = [&](std::size_t corner, int slot) {
        const tinyobj::index_t index = corners[corner];
        if (index.vertex_index < 0 ||
            static_cast<std::size_t>(index.vertex_index) >= model.vertices.size())
            return Status::Error(
                fmt::format("{}: a face of '{}' refers to vertex {}, but there are only {}", path,
                            model.object_names[triangle.object], index.vertex_index + 1,
                            model.vertices.size()));
        triangle.vertices[slot] = static_cast<std::uint32_t>(index.vertex_index);
        triangle.uv[slot].setZero();
        const auto uv = static_cast<std::size_t>(std::max(index.texcoord_index, 0)) * 2;
        if (index.texcoord_index >= 0 && uv + 1 < attributes.texcoords.size()) {
            const Eigen::Vector2f point(attributes.texcoords[uv], attributes.texcoords[uv + 1]);
            if (point.allFinite() && point.cwiseAbs().maxCoeff() < kLargestUv)
                triangle.uv[slot] = point;
        }
        return Status::Ok();
    };
    for (std::size_t i = 2; i < count; ++i) {
        for (const auto& [corner, slot] : {std::pair<std::size_t, int>{0, 0}, {i - 1, 1}, {i, 2}})
            if (Status status = take(corner, slot); !status.ok()) return status;
        const auto [a, b, c] = triangle.vertices;
        if (a != b && b != c && c != a) model.triangles.push_back(triangle);
    }
    return Status::Ok();
}

Status TakeShape(const std::string& path, const tinyobj::attrib_t& attributes,
                 const tinyobj::mesh_t& mesh, ObjModel& model) {
    std::size_t at = 0;
    const int no_material = static_cast<int>(model.materials.size()) - 1;
    for (std::size_t face = 0; face < mesh.num_face_vertices.size(); ++face) {
        const std::size_t count = mesh.num_face_vertices[face];
        if (at + count > mesh.indices.size())
            return Status::Error(
                fmt::format("{}: a face of '{}' has more than 255 corners; triangulate the model",
                            path, model.object_names.back()));
        ObjModel::Triangle triangle{};
        triangle.object = static_cast<int>(model.object_names.size()) - 1;
        const int material = face < mesh.material_ids.size() ? mesh.material_ids[face] : -1;
        triangle.material = material >= 0 && material < no_material ? material : no_material;
        if (Status status =
                TakePolygon(path, attributes, mesh.indices.data() + at, count, triangle, model);
            !status.ok())
            return status;
        at += count;
    }
    return Status::Ok();
}

// Reads the material files that a model names, next to it.
class MaterialFiles : public tinyobj::MaterialReader {
  public:
    explicit MaterialFiles(std::string prefix) : prefix_(std::move(prefix)) {}

    bool operator()(const std::string& name, std::vector<tinyobj::material_t>* materials,
                    std::map<std::string, int>* numbers, std::string* warning,
                    std::string* problem) override {
        const Result<std::string> text = ReadWholeFile(prefix_ + name, kMaxMaterialBytes);
        if (!text.ok()) {
            *warning += text.message() + "\n";
            return false;
        }
        std::istringstream lines(text.value());
        tinyobj::LoadMtl(numbers, materials, &lines, warning, problem);
        return true;
    }

  private:
    std::string prefix_;
};

Result<ObjModel> Parse(const std::string& path) {
    const Result<std::string> text = ReadWholeFile(path, kMaxModelBytes);
    if (!text.ok()) return Status::Error(text.message() + " (a Wavefront .obj model is needed)");
    const std::string folder = std::filesystem::path(path).parent_path().string();
    const std::string prefix = folder.empty() ? "" : folder + "/";
    tinyobj::attrib_t attributes;
    std::vector<tinyobj::shape_t> shapes;
    std::vector<tinyobj::material_t> materials;
    std::string warning, problem;
    // The parser does not triangulate: it would do so before the indices are checked.
    std::istringstream lines(text.value());
    MaterialFiles files(prefix);
    if (!tinyobj::LoadObj(&attributes, &shapes, &materials, &warning, &problem, &lines, &files,
                          false)) {
        problem = problem.substr(0, problem.find('\n'));
        return Status::Error(fmt::format("{}: not a readable .obj model{}{}", path,
                                         problem.empty() ? "" : ": ", problem));
    }
    ObjModel model;
    if (Status status = TakeVertices(path, attributes, model); !status.ok()) return status;
    TakeMaterials(prefix, materials, model);
    for (const tinyobj::shape_t& shape : shapes) {
        if (shape.mesh.indices.empty()) continue;
        model.object_names.push_back(shape.name.empty()
                                         ? fmt::format("object {}", model.object_names.size() + 1)
                                         : shape.name);
        if (Status status = TakeShape(path, attributes, shape.mesh, model); !status.ok())
            return status;
    }
    if (model.triangles.empty())
        return Status::Error(path + ": contains no triangles; export the model with faces");
    if (model.object_names.size() > 65534)
        return Status::Error(
            fmt::format("{}: {} objects, but instance images can number only 65534; join some",
                        path, model.object_names.size()));
    return model;
}

}  // namespace

Result<ObjModel> ReadObj(const std::string& path) {
    try {
        return Parse(path);
    } catch (const std::exception& error) {
        return Status::Error(fmt::format("{}: cannot be read: {}", path, error.what()));
    }
}

}  // namespace tessera
