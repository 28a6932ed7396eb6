// Files of text: the camera, the configuration, lists, paths, detections and objects.
#include <algorithm>
#include <cmath>

#include "core/camera.h"
#include "fuzz/fuzz_target.h"
#include "io/detections_text.h"
#include "io/image_lists.h"
#include "io/trajectory.h"
#include "semantics/objects_file.h"
#include "system/run_config.h"

namespace tessera::fuzz {
namespace {

void ReadCamera(std::span<const std::uint8_t> bytes) {
    const BytesAsFile file(bytes);
    const Result<CameraCalibration> camera = ReadCameraFile(file.path());
    CheckError(camera.status(), file.path());
    if (!camera.ok()) return;
    TESSERA_CHECK(CheckPlausible(camera.value().pinhole).ok(), "an implausible camera");
    const std::string text = CameraFileText(camera.value());
    const BytesAsFile again(BytesOf(text));
    TESSERA_CHECK(ReadCameraFile(again.path()).ok(), "what was read cannot be written: {}", text);
}

void ReadConfiguration(std::span<const std::uint8_t> bytes) {
    const BytesAsFile file(bytes);
    RunConfig config;
    ConfigParameters parameters;
    config.Describe(parameters);
    const Status read = parameters.LoadYamlFile(file.path());
    CheckError(read, file.path());
    if (!read.ok()) return;
    const std::string text = parameters.ToYaml();
    TESSERA_CHECK(parameters.LoadYaml(text, "again").ok() && parameters.ToYaml() == text,
                  "what was read cannot be written: {}", text);
}

void ReadPath(std::span<const std::uint8_t> bytes) {
    const BytesAsFile file(bytes);
    const Result<Trajectory> path = ReadTrajectory(file.path());
    CheckError(path.status(), file.path());
    if (!path.ok()) return;
    const std::vector<StampedPose>& poses = path.value().poses;
    for (std::size_t i = 0; i < poses.size(); ++i) {
        TESSERA_CHECK(poses[i].T_world_camera.matrix().allFinite(), "pose {} is not finite", i);
        TESSERA_CHECK(i == 0 || poses[i - 1].stamp_s < poses[i].stamp_s, "pose {} is not later", i);
    }
    (void)InterpolatePose(poses, poses.front().stamp_s + 0.01);
}

void CheckPairs(const Result<ImagePairs>& images, const std::string& path) {
    CheckError(images.status(), path);
    if (!images.ok()) return;
    const std::vector<ImagePair>& pairs = images.value().pairs;
    for (std::size_t i = 0; i < pairs.size(); ++i)
        TESSERA_CHECK(std::isfinite(pairs[i].depth_stamp_s) &&
                          (i == 0 || pairs[i - 1].depth_stamp_s < pairs[i].depth_stamp_s),
                      "pair {} is not later", i);
}

void ReadLists(std::span<const std::uint8_t> bytes) {
    const BytesAsFile file(bytes);
    CheckPairs(ReadImageLists(file.path(), file.path(), 0.02), file.path());
    CheckPairs(ReadAssociations(file.path()), file.path());
}

void ReadRows(std::span<const std::uint8_t> bytes) {
    const BytesAsFile file(bytes);
    const Result<DetectionRows> rows = ReadDetectionRows(file.path());
    CheckError(rows.status(), file.path());
    if (!rows.ok()) return;
    for (const DetectionRow& row : rows.value().rows)
        TESSERA_CHECK(std::isfinite(row.stamp_s) && row.box.Area() > 0 && row.probability >= 0 &&
                          row.probability <= 1,
                      "a detection that makes no sense");
}

void ReadObjectList(std::span<const std::uint8_t> bytes) {
    const BytesAsFile file(bytes);
    const Result<std::vector<MapObject>> objects = ReadObjects(file.path());
    CheckError(objects.status(), file.path());
    if (objects.ok()) (void)ObjectsJson(objects.value());
}

std::string SomeObjects() {
    MapObject object;
    object.id = 1;
    object.class_id = 2;
    object.class_name = "cup";
    object.observations = 3;
    object.vertices = 10;
    object.box = Eigen::AlignedBox3d(Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(1, 2, 3));
    object.embedding = {0.6f, 0.8f};
    return ObjectsJson({object, object});
}

std::string SomeConfiguration() {
    RunConfig config;
    ConfigParameters parameters;
    config.Describe(parameters);
    return parameters.ToYaml();
}

}  // namespace

std::vector<FuzzTarget> TextTargets() {
    const auto text = [](std::vector<std::string> texts) {
        return [texts] {
            std::vector<Bytes> seeds;
            for (const std::string& one : texts) seeds.push_back(BytesOf(one));
            return seeds;
        };
    };
    CameraCalibration lens;
    lens.distortion = {0.1, -0.2, 0.001, 0.002, 0.3};
    CameraCalibration two = lens;
    two.colour.emplace().T_colour_depth.translation().x() = -0.025;
    return {
        {"camera", text({CameraFileText({}), CameraFileText(lens), CameraFileText(two)}),
         ReadCamera},
        {"config", text({SomeConfiguration(), "mapping: {voxel_size_m: 0.02}\n"}),
         ReadConfiguration, 500},
        {"trajectory",
         text({"# stamp tx ty tz qx qy qz qw\n1.5 0 1e-3 -2 0 0 0.6 0.8\n1.6,1,2,3,0,0,0,1\n"}),
         ReadPath},
        {"lists",
         text({"# list\n1.0 depth/1.png\n1.01 depth/a b.png\n+2.5\tc.png # x\n",
               "1.0 depth/1.png 1.01 rgb/1.png\n2.0 rgb/2.png 2.01 depth/2.png\n"}),
         ReadLists},
        {"detections",
         text({"# classes cup book\n# aliases mug=cup\n# frame 1.5\n1.5 cup 0.9 10 20 30 40\n"}),
         ReadRows},
        {"objects", text({SomeObjects()}), ReadObjectList},
    };
}

}  // namespace tessera::fuzz
