#include "system/engine_steps.h"

#include <fmt/format.h>

#include <chrono>
#include <thread>

#include "io/mesh_io.h"

namespace tessera {

Status StartRecording(const std::string& path, const RecordConfig& config, FrameSource& source,
                      RecorderThread& recorder) {
    if (path.ends_with(".oni")) return source.RecordTo(path, config.colour == RecordConfig::Colour::kPng);
    return recorder.Start(path);
}

std::string SaveMesh(const MappingStage& mapping, const std::string& path) {
    const TriangleMesh mesh = mapping.Mesh();
    if (mesh.triangles.empty()) return "no surface to save yet";
    const Status status = WritePly(path, mesh);
    if (!status.ok()) return status.message();
    return fmt::format("saved {}: {} triangles", path, mesh.triangles.size());
}

void PauseBriefly() { std::this_thread::sleep_for(std::chrono::milliseconds(10)); }

}  // namespace tessera
