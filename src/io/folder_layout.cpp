#include "io/folder_layout.h"

#include <algorithm>
#include <filesystem>
#include <sstream>

#include "core/input_file.h"
#include "io/folder_truth.h"
#include "io/image_lists.h"
#include "io/named_images.h"
#include "io/open3d_camera.h"
#include "io/published_cameras.h"
#include "io/stamp_pairing.h"

namespace tessera {
namespace {

namespace fs = std::filesystem;

enum class Layout { kLists, kAssociations, kSevenScenes, kNamedImages };

bool Exists(const fs::path& path) {
    std::error_code error;
    return fs::exists(path, error);
}

// The folder's own name, also for "." and with a trailing slash.
std::string FolderName(const fs::path& folder) {
    std::error_code error;
    const fs::path whole = fs::canonical(folder, error);
    return (error ? folder : whole).filename().string();
}

Status CheckFolder(const std::string& folder) {
    std::error_code error;
    const fs::file_status status = fs::status(folder, error);
    if (!fs::exists(status)) return Status::Error(folder + ": no such folder");
    if (!fs::is_directory(status))
        return Status::Error(folder + ": is a file; give the folder of a recorded sequence");
    if (fs::is_empty(folder, error)) return Status::Error(folder + ": is empty");
    if (error) return Status::Error(fmt::format("{}: cannot be read: {}", folder, error.message()));
    return Status::Ok();
}

Result<Layout> RecogniseLayout(const fs::path& folder) {
    const bool rgb = Exists(folder / "rgb.txt"), depth = Exists(folder / "depth.txt");
    if (rgb && depth) return Layout::kLists;
    if (Exists(folder / "associations.txt")) return Layout::kAssociations;
    if (rgb != depth)
        return Status::Error(fmt::format("{}: there is {} but no {}", folder.string(),
                                         rgb ? "rgb.txt" : "depth.txt",
                                         rgb ? "depth.txt" : "rgb.txt"));
    if (Exists(folder / "frame-000000.depth.png") || Exists(folder / "frame-000000.color.png"))
        return Layout::kSevenScenes;
    if (FindImageFolders(folder.string()).complete()) return Layout::kNamedImages;
    const bool parent = Exists(folder / "seq-01");
    return Status::Error(fmt::format(
        "{}: {}", folder.string(),
        parent ? std::string("contains several sequences; give one of them, such as seq-01")
               : std::string(kUnknownLayout) +
                     "; expected rgb.txt and depth.txt (TUM), "
                     "associations.txt (ICL-NUIM), "
                     "frame-000000.depth.png (7-Scenes), or camera.yaml with depth/ and rgb/"));
}

// TUM's lists name the recording in a comment, even if the folder was renamed: "# file:
// 'rgbd_dataset_freiburg1_rpy.bag'".
std::string BagName(const fs::path& folder) {
    constexpr std::size_t kLongest = 1000;
    const Result<InputFile> list = InputFile::Open((folder / "rgb.txt").string());
    if (!list.ok()) return {};
    std::vector<std::uint8_t> bytes(std::min<std::uint64_t>(kLongest, list.value().size()));
    if (!list.value().ReadAt(0, bytes).ok()) return {};
    std::istringstream lines(std::string(bytes.begin(), bytes.end()));
    std::string line;
    for (int i = 0; i < 2 && std::getline(lines, line); ++i)
        if (line.starts_with('#') && line.find("rgbd_dataset_") != std::string::npos) return line;
    return {};
}

std::string PublishedName(const fs::path& folder, const std::string& by_layout) {
    for (const std::string& text : {FolderName(folder), BagName(folder)})
        for (const char* tum : {"freiburg1", "freiburg2", "freiburg3"})
            if (text.find(tum) != std::string::npos) return tum;
    return by_layout;
}

// nullopt if the camera is unknown.
Result<std::optional<CameraCalibration>> FindCamera(const fs::path& folder,
                                                    const std::string& published,
                                                    bool depth_scale_set, FolderLayout& layout) {
    std::vector<std::string>& notes = layout.notes;
    const fs::path file = folder / "camera.yaml";
    if (Exists(file)) {
        const Result<CameraCalibration> read = ReadCameraFile(file.string());
        if (!read.ok()) return read.status();
        layout.camera_from = "camera.yaml";
        if (!read.value().depth_scale_given && !depth_scale_set)
            notes.push_back(fmt::format(
                "camera.yaml has no depth_scale: assuming {} stored units per metre; correct it if "
                "depths come out too long or too short",
                read.value().depth_scale));
        return std::optional(read.value());
    }
    const auto open3d = ReadOpen3dCamera(folder.string());
    if (!open3d.ok()) return open3d.status();
    if (open3d.value()) {
        layout.camera_from = open3d.value()->file;
        notes.push_back(fmt::format("camera from {}, depth in millimetres", open3d.value()->file));
        return std::optional(open3d.value()->calibration);
    }
    const std::string name = PublishedName(folder, published);
    std::optional<CameraCalibration> camera = PublishedCamera(name);
    if (camera) {
        layout.camera_from = "the published calibration of " + name;
        notes.push_back(
            fmt::format("no camera.yaml: using {}; add a camera.yaml if this is a different camera",
                        layout.camera_from));
    }
    return camera;
}

Result<ImagePairs> ReadPairs(const fs::path& folder, Layout layout, double fps,
                             double max_pair_gap_s, double colour_delay_s) {
    switch (layout) {
        case Layout::kLists:
            return ReadImageLists((folder / "depth.txt").string(), (folder / "rgb.txt").string(),
                                  max_pair_gap_s, colour_delay_s);
        case Layout::kAssociations: return ReadAssociations((folder / "associations.txt").string());
        case Layout::kSevenScenes: return ReadSevenScenesNames(folder.string(), fps);
        case Layout::kNamedImages: break;
    }
    return PairByName(folder.string(), FindImageFolders(folder.string()), fps, max_pair_gap_s,
                      colour_delay_s);
}

// Such names alone say little: other people have living rooms, too.
bool HasIclName(const fs::path& folder) {
    const std::string name = FolderName(folder);
    for (const char* part : {"living_room", "livingRoom", "office_room", "frei_png"})
        if (name.find(part) != std::string::npos) return true;
    return false;
}

bool IsIclFolder(const fs::path& folder, Layout layout) {
    if (layout != Layout::kLists && layout != Layout::kAssociations) return false;
    if (!FindIclTruth(folder.string()).empty()) return true;
    const bool by_default = layout == Layout::kAssociations && !Exists(folder / "camera.yaml");
    if (!by_default && !HasIclName(folder)) return false;
    const auto images = ReadPairs(folder, layout, 0, 0, 0);
    return images.ok() && StampsAreFrameNumbers(images.value().pairs);
}

Status AddFrames(const fs::path& folder, const std::vector<ImagePair>& pairs,
                 FolderLayout& layout) {
    std::size_t absent = 0;
    std::string first_absent;
    for (const ImagePair& pair : pairs) {
        FolderFrame frame{pair.depth_stamp_s, pair.colour_stamp_s, (folder / pair.depth).string(),
                          (folder / pair.colour).string(), std::nullopt};
        const bool has_depth = Exists(frame.depth_path);
        if (!has_depth || !Exists(frame.colour_path)) {
            if (absent++ == 0) first_absent = has_depth ? frame.colour_path : frame.depth_path;
        }
        layout.frames.push_back(std::move(frame));
    }
    if (absent == pairs.size())
        return Status::Error(
            fmt::format("{}: no such file; none of the {} frames has both of its images. Are the "
                        "images unpacked, and does the list belong to them?",
                        first_absent, absent));
    if (absent > 0)
        layout.notes.push_back(
            fmt::format("{} of {} frames lack an image (first: {}); they will be skipped", absent,
                        pairs.size(), first_absent));
    return Status::Ok();
}

// Sets the layout's kind and peculiarities. Returns the name of its published camera.
std::string Characterise(const fs::path& folder, Layout layout, FolderLayout& result) {
    if (IsIclFolder(folder, layout)) {
        result.kind = "ICL-NUIM folder";
        return "icl_nuim";
    }
    if (layout == Layout::kSevenScenes) {
        constexpr std::uint16_t kSevenScenesInvalid = 65535;
        result.kind = "7-Scenes sequence";
        result.invalid_depth = kSevenScenesInvalid;
        return "seven_scenes";
    }
    result.kind = layout == Layout::kNamedImages ? "image folder" : "TUM RGB-D folder";
    return {};
}

}  // namespace

Result<FolderLayout> ReadFolderLayout(const std::string& path, double max_pair_gap_s,
                                      double colour_delay_s, bool depth_scale_set) {
    if (Status status = CheckFolder(path); !status.ok()) return status;
    const fs::path folder(path);
    const Result<Layout> layout = RecogniseLayout(folder);
    if (!layout.ok()) return layout.status();

    FolderLayout result;
    const std::string published = Characterise(folder, layout.value(), result);
    const auto calibration = FindCamera(folder, published, depth_scale_set, result);
    if (!calibration.ok()) return calibration.status();
    result.camera_known = calibration.value().has_value();
    result.calibration = calibration.value().value_or(CameraCalibration());
    const bool own = Exists(folder / "camera.yaml");
    result.registration_known = own || !result.calibration.colour;
    if (!result.registration_known)
        result.notes.push_back(
            "7-Scenes: colour is registered to depth by the calibration of another Kinect");

    auto images =
        ReadPairs(folder, layout.value(), result.calibration.fps, max_pair_gap_s, colour_delay_s);
    if (!images.ok()) return images.status();
    ImagePairs& found = images.value();
    const bool numbered = StampsAreFrameNumbers(found.pairs);
    if (!numbered) {
        result.correction = StampCorrection::Of(colour_delay_s, ShareStamps(found.pairs));
        for (ImagePair& pair : found.pairs) {
            pair.depth_stamp_s += result.correction.depth_s;
            pair.colour_stamp_s += result.correction.colour_s;
        }
    }
    result.notes.insert(result.notes.end(), found.notes.begin(), found.notes.end());
    if (Status status = AddFrames(folder, found.pairs, result); !status.ok()) return status;
    if (!numbered) result.warnings = StampWarnings(found);
    AddTruth(path, numbered, result);
    return result;
}

}  // namespace tessera
