#include "report/viewer_data.h"

#include <Eigen/Geometry>
#include <bit>
#include <cmath>
#include <nlohmann/json.hpp>

#include "report/mesh_packing.h"
#include "report/page_text.h"
#include "report/report_charts.h"
#include "report/view_up.h"
#include "semantics/label_config.h"

namespace tessera {
namespace {

using Json = nlohmann::ordered_json;

std::string Element(const char* id, const char* type, const std::string& text) {
    return fmt::format("<script type=\"{}\" id=\"{}\">{}</script>\n", type, id, text);
}

std::string Bytes(const char* id, std::span<const std::uint8_t> bytes) {
    return bytes.empty() ? std::string() : Element(id, "text/plain", Base64(bytes));
}

class Floats {
  public:
    void Add(double value) {
        const auto bits = std::bit_cast<std::uint32_t>(static_cast<float>(value));
        for (int shift = 0; shift < 32; shift += 8)
            bytes_.push_back(static_cast<std::uint8_t>(bits >> shift));
    }
    void Add(const Eigen::Vector3d& p) {
        for (const double x : p) Add(x);
    }
    const std::vector<std::uint8_t>& bytes() const { return bytes_; }

  private:
    std::vector<std::uint8_t> bytes_;  // little endian
};

// A millimetre or a thousandth is enough, and short.
Json Rounded(const Eigen::Vector3d& v) {
    Json json = Json::array();
    for (const double x : v) json.push_back(std::round(x * 1e4) / 1e4);
    return json;
}

Json Quaternion(const Eigen::Isometry3d& T) {
    const Eigen::Quaterniond q(T.linear());
    return {q.x(), q.y(), q.z(), q.w()};
}

Json Colour(const Rgb8& c) { return {c.r, c.g, c.b}; }

Json BoxesJson(const std::vector<MapObject>& objects) {
    Json json = Json::array();
    for (const MapObject& o : objects)
        json.push_back({{"id", o.id},
                        {"name", Printable(o.class_name)},
                        {"colour", Colour(o.colour)},
                        {"centre", Rounded(o.T_world_oriented.translation())},
                        {"size", Rounded(o.oriented_size)},
                        {"q", Quaternion(o.T_world_oriented)}});
    return json;
}

Json PaletteJson(const PackedMesh& packed, const std::vector<MapObject>& objects) {
    Json json = Json::array();
    for (const int class_id : packed.classes) {
        Rgb8 colour = DistinctColour(class_id);
        for (const MapObject& o : objects)
            if (o.class_id == class_id) colour = o.colour;
        json.push_back(Colour(colour));
    }
    return json;
}

Json FramesJson(const ReportData& data, double begin_s) {
    Json json = Json::array();
    if (data.frames)
        for (const FrameRow& row : data.frames->rows)
            json.push_back({row.index, std::round((row.stamp_s - begin_s) * 1e4) / 1e4,
                            static_cast<int>(row.state), std::round(row.frame_ms * 10) / 10});
    return json;
}

}  // namespace

std::string ViewerData(const ReportData& data, const TriangleMesh& mesh) {
    const double begin_s = TimeRangeOf(data).begin_s;
    const PackedMesh packed = PackMesh(mesh);
    Json json = {{"vertices", packed.vertex_count},
                 {"triangles", packed.triangle_count},
                 {"low", {packed.low.x(), packed.low.y(), packed.low.z()}},
                 {"step", {packed.step.x(), packed.step.y(), packed.step.z()}},
                 {"palette", PaletteJson(packed, data.objects)},
                 {"up", Rounded(EstimateUp(mesh, data.path))},
                 {"camera", nullptr},
                 {"objects", BoxesJson(data.objects)},
                 {"frames", FramesJson(data, begin_s)}};
    if (data.record && data.record->camera) {
        const PinholeCamera& camera = *data.record->camera;
        json["camera"] = {camera.width / camera.fx, camera.height / camera.fy};
    }
    Floats poses, tracked, truth;
    for (const StampedPose& pose : data.path) {
        poses.Add(pose.stamp_s - begin_s);
        poses.Add(pose.T_world_camera.translation());
        const Eigen::Quaterniond q(pose.T_world_camera.linear());
        for (const double x : {q.x(), q.y(), q.z(), q.w()}) poses.Add(x);
    }
    for (const StampedPose& pose : data.tracked_path)
        tracked.Add(pose.T_world_camera.translation());
    if (data.ate)
        for (const AteResult::Pair& pair : data.ate->pairs)
            truth.Add(data.ate->T_reference_estimate.inverse() * pair.p_reference);
    return Element("data", "application/json",
                   EscapeScriptJson(json.dump(-1, ' ', false, Json::error_handler_t::replace))) +
           Bytes("vertices", packed.vertices) + Bytes("corners", packed.corners) +
           Bytes("poses", poses.bytes()) + Bytes("tracked", tracked.bytes()) +
           Bytes("truth", truth.bytes());
}

}  // namespace tessera
