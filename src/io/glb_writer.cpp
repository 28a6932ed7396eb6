// Binary glTF 2.0: a header, a chunk of JSON and a chunk of bytes
// (https://registry.khronos.org/glTF/specs/2.0/glTF-2.0.html, section 4).
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "core/check.h"
#include "io/file.h"
#include "io/jpeg_encoder.h"
#include "io/mesh_writers.h"
#include "io/textured_mesh.h"

namespace tessera {
namespace {

static_assert(std::endian::native == std::endian::little, "glTF files are little endian");
static_assert(sizeof(Eigen::Vector3f) == 12 && sizeof(std::array<std::uint32_t, 3>) == 12,
              "arrays are written as raw memory");

constexpr std::uint32_t kGlbMagic = 0x46546c67, kVersion = 2, kJsonChunk = 0x4e4f534a,
                        kBinaryChunk = 0x004e4942;
constexpr int kFloat = 5126, kUnsignedShort = 5123, kUnsignedInt = 5125, kArrayBuffer = 34962,
              kElementBuffer = 34963, kLinear = 9729;

// With alpha, so that each element is aligned to four bytes.
using Colour16 = std::array<std::uint16_t, 4>;

template <class T>
std::string_view BytesOf(const std::vector<T>& values) {
    return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)};
}

// IEC 61966-2-1, in steps of 1 / 65535.
std::array<std::uint16_t, 256> LinearOfSrgb() {
    std::array<std::uint16_t, 256> table{};
    for (std::size_t i = 0; i < table.size(); ++i) {
        const double s = static_cast<double>(i) / 255.0;
        const double linear = s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4);
        table[i] = static_cast<std::uint16_t>(std::lround(65535.0 * linear));
    }
    return table;
}

// What is written. `uv` and `jpeg` belong to a textured mesh, whose vertex colours are left out.
struct GlbContent {
    const TriangleMesh& mesh;
    const std::vector<Eigen::Vector2f>* uv = nullptr;
    std::vector<std::uint8_t> jpeg;

    bool textured() const { return uv != nullptr; }
    std::size_t padding() const { return (4 - jpeg.size() % 4) % 4; }
};

// Collects the JSON descriptions of the arrays: their position in the binary chunk and their
// format.
class Arrays {
  public:
    // Returns the accessor's index.
    int Add(std::size_t count, std::size_t bytes, int target, nlohmann::json accessor) {
        const auto number = static_cast<int>(views_.size());
        views_.push_back(
            {{"buffer", 0}, {"byteOffset", bytes_}, {"byteLength", bytes}, {"target", target}});
        accessor["bufferView"] = number;
        accessor["count"] = count;
        accessors_.push_back(std::move(accessor));
        bytes_ += bytes;
        return number;
    }
    // Bytes that are no array. Returns the view's index.
    int AddImage(std::size_t bytes) {
        views_.push_back({{"buffer", 0}, {"byteOffset", bytes_}, {"byteLength", bytes}});
        bytes_ += (bytes + 3) / 4 * 4;
        return static_cast<int>(views_.size()) - 1;
    }
    std::size_t bytes() const { return bytes_; }
    const nlohmann::json& views() const { return views_; }
    const nlohmann::json& accessors() const { return accessors_; }

  private:
    nlohmann::json views_ = nlohmann::json::array(), accessors_ = nlohmann::json::array();
    std::size_t bytes_ = 0;
};

nlohmann::json PositionAccessor(const TriangleMesh& mesh) {
    Eigen::Vector3f low = mesh.vertices.front(), high = low;
    for (const Eigen::Vector3f& v : mesh.vertices) {
        low = low.cwiseMin(v);
        high = high.cwiseMax(v);
    }
    return {{"componentType", kFloat},
            {"type", "VEC3"},
            {"min", {low.x(), low.y(), low.z()}},
            {"max", {high.x(), high.y(), high.z()}}};
}

// The arrays must be in the order in which WriteArrays writes them.
nlohmann::json Describe(const GlbContent& content, Arrays& arrays) {
    const TriangleMesh& mesh = content.mesh;
    const std::size_t count = mesh.vertices.size();
    nlohmann::json attributes;
    attributes["POSITION"] = arrays.Add(count, 12 * count, kArrayBuffer, PositionAccessor(mesh));
    if (!mesh.normals.empty())
        attributes["NORMAL"] = arrays.Add(count, 12 * count, kArrayBuffer,
                                          {{"componentType", kFloat}, {"type", "VEC3"}});
    if (content.textured())
        attributes["TEXCOORD_0"] = arrays.Add(count, 8 * count, kArrayBuffer,
                                              {{"componentType", kFloat}, {"type", "VEC2"}});
    else if (!mesh.colours.empty())
        attributes["COLOR_0"] =
            arrays.Add(count, sizeof(Colour16) * count, kArrayBuffer,
                       {{"componentType", kUnsignedShort}, {"type", "VEC4"}, {"normalized", true}});
    const std::size_t corners = 3 * mesh.triangles.size();
    const int indices = arrays.Add(corners, 4 * corners, kElementBuffer,
                                   {{"componentType", kUnsignedInt}, {"type", "SCALAR"}});
    return {{"attributes", attributes}, {"indices", indices}, {"material", 0}, {"mode", 4}};
}

std::string Json(const GlbContent& content, std::size_t& binary_bytes) {
    Arrays arrays;
    const nlohmann::json primitive = Describe(content, arrays);
    const int image = content.textured() ? arrays.AddImage(content.jpeg.size()) : -1;
    binary_bytes = arrays.bytes();
    nlohmann::json surface = {
        {"name", "scanned surface"},
        {"pbrMetallicRoughness", {{"metallicFactor", 0.0}, {"roughnessFactor", 1.0}}}};
    const nlohmann::json node = {{"name", "scan"}, {"mesh", 0}, {"rotation", {1.0, 0.0, 0.0, 0.0}}};
    nlohmann::json file = {{"asset", {{"version", "2.0"}, {"generator", "tessera"}}},
                           {"scene", 0},
                           {"scenes", {{{"nodes", {0}}}}},
                           {"nodes", {node}},
                           {"materials", {surface}},
                           {"meshes", {{{"primitives", {primitive}}}}},
                           {"buffers", {{{"byteLength", binary_bytes}}}},
                           {"bufferViews", arrays.views()},
                           {"accessors", arrays.accessors()}};
    if (content.textured()) {
        surface["pbrMetallicRoughness"]["baseColorTexture"] = {{"index", 0}};
        surface["extensions"]["KHR_materials_unlit"] = nlohmann::json::object();
        // Braces alone are an array for one compiler and a copy for another.
        using nlohmann::json;
        file["materials"] = json::array({surface});
        file["extensionsUsed"] = json::array({"KHR_materials_unlit"});
        file["images"] = json::array({json{{"bufferView", image}, {"mimeType", "image/jpeg"}}});
        file["samplers"] = json::array({json{{"magFilter", kLinear}, {"minFilter", kLinear}}});
        file["textures"] = json::array({json{{"source", 0}, {"sampler", 0}}});
    }
    std::string text = file.dump();
    text.resize((text.size() + 3) / 4 * 4, ' ');
    return text;
}

void WriteNumbers(AtomicFile& file, std::initializer_list<std::size_t> numbers) {
    std::vector<std::uint32_t> words;
    for (const std::size_t number : numbers) words.push_back(static_cast<std::uint32_t>(number));
    file.Write(BytesOf(words));
}

void WriteColours(AtomicFile& file, const std::vector<Rgb8>& colours) {
    const std::array<std::uint16_t, 256> linear = LinearOfSrgb();
    for (const Rgb8& c : colours) {
        const Colour16 colour{linear[c.r], linear[c.g], linear[c.b], 65535};
        file.Write({reinterpret_cast<const char*>(&colour), sizeof(colour)});
    }
}

void WriteArrays(AtomicFile& file, const GlbContent& content) {
    const TriangleMesh& mesh = content.mesh;
    file.Write(BytesOf(mesh.vertices));
    file.Write(BytesOf(mesh.normals));
    if (content.textured())
        file.Write(BytesOf(*content.uv));
    else
        WriteColours(file, mesh.colours);
    file.Write(BytesOf(mesh.triangles));
    file.Write(BytesOf(content.jpeg));
    file.Write(std::string(content.padding(), '\0'));
}

Status Write(const std::string& path, const GlbContent& content) {
    const TriangleMesh& mesh = content.mesh;
    CheckVertexProperties(mesh);
    if (mesh.triangles.empty())
        return Status::Error(path +
                             ": the mesh is empty, which glTF cannot represent; write it as .ply");
    std::size_t binary_bytes = 0;
    const std::string json = Json(content, binary_bytes);
    const std::size_t bytes = 12 + 8 + json.size() + 8 + binary_bytes;
    if (bytes > std::numeric_limits<std::uint32_t>::max())
        return Status::Error(path +
                             ": the mesh exceeds the 4 GiB limit of a glTF file; write it as .ply");
    AtomicFile file(path);
    WriteNumbers(file, {kGlbMagic, kVersion, bytes, json.size(), kJsonChunk});
    file.Write(json);
    WriteNumbers(file, {binary_bytes, kBinaryChunk});
    WriteArrays(file, content);
    return file.Commit();
}

}  // namespace

Status WriteGlb(const std::string& path, const TriangleMesh& mesh) {
    return Write(path, {mesh, nullptr, {}});
}

Status WriteTexturedGlb(const std::string& path, const TexturedMesh& model) {
    TESSERA_CHECK(model.uv.size() == model.mesh.vertices.size(), "{} of {}", model.uv.size(),
                  model.mesh.vertices.size());
    GlbContent content{model.mesh, &model.uv, {}};
    if (Status status = EncodeJpeg(model.texture, kFineJpegQuality, content.jpeg); !status.ok())
        return Status::Error(path + ": " + status.message());
    return Write(path, content);
}

}  // namespace tessera
