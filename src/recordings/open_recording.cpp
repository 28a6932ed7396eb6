#include "recordings/open_recording.h"

#include <array>
#include <filesystem>

#include "recordings/endings.h"
#include "recordings/mkv_recording.h"
#include "recordings/polycam_recording.h"
#include "recordings/record3d_recording.h"
#include "recordings/recording_source.h"
#include "recordings/ros_recording.h"
#include "recordings/sens_recording.h"
#include "recordings/stray_recording.h"

namespace tessera {
namespace {

struct RecordingKind {
    const char* ending;                     // of a file; nullptr: a folder
    bool (*is_folder)(const std::string&);  // nullptr: a file
    RecordingResult (*open)(const std::string& path, const FolderSourceConfig& config);
};

template <RecordingResult (*kOpen)(const std::string&)>
RecordingResult WithoutConfig(const std::string& path, const FolderSourceConfig&) {
    return kOpen(path);
}

RecordingResult OpenRos(const std::string& path, const FolderSourceConfig& config) {
    return OpenRosRecording(path, config.max_pair_gap_s, config.colour_delay_s,
                            {config.depth_topic, config.colour_topic});
}

RecordingResult OpenAzure(const std::string& path, const FolderSourceConfig& config) {
    return OpenMkv(path, config.colour_delay_s);
}

constexpr std::array kRecordingKinds{
    RecordingKind{".bag", nullptr, OpenRos},
    RecordingKind{".mcap", nullptr, OpenRos},
    RecordingKind{".db3", nullptr, OpenRos},
    RecordingKind{".mkv", nullptr, OpenAzure},
    RecordingKind{".r3d", nullptr, WithoutConfig<OpenRecord3d>},
    RecordingKind{".sens", nullptr, WithoutConfig<OpenSensRecording>},
    RecordingKind{nullptr, IsStrayFolder, WithoutConfig<OpenStrayRecording>},
    RecordingKind{nullptr, IsPolycamFolder, WithoutConfig<OpenPolycamRecording>},
    RecordingKind{nullptr, IsRosFolder, OpenRos}};

constexpr RecordingKind kCompressedRos{".zstd", nullptr, OpenRos};

const RecordingKind* KindOfRecording(const std::string& path) {
    std::error_code ignored;
    const bool folder = std::filesystem::is_directory(path, ignored);
    if (!folder && IsCompressedRosFile(path)) return &kCompressedRos;
    for (const RecordingKind& kind : kRecordingKinds)
        if (folder ? kind.is_folder != nullptr && kind.is_folder(path)
                   : kind.ending != nullptr && EndingOf(path) == kind.ending)
            return &kind;
    return nullptr;
}

// The camera.yaml in a recording's folder or beside its file; "" if there is none.
std::string CameraBeside(const std::string& path) {
    std::error_code ignored;
    const std::filesystem::path at(path);
    const auto folder = std::filesystem::is_directory(at, ignored) ? at : at.parent_path();
    const auto file = folder / "camera.yaml";
    return std::filesystem::exists(file, ignored) ? file.string() : std::string();
}

}  // namespace

bool RecordingsAvailable() { return true; }

bool IsRecording(const std::string& path) { return KindOfRecording(path) != nullptr; }

Result<std::unique_ptr<FrameSource>> OpenRecording(const std::string& path,
                                                   const FolderSourceConfig& config) {
    const RecordingKind* kind = KindOfRecording(path);
    if (kind == nullptr) return Status::Error(path + ": is no recording");
    RecordingResult recording = kind->open(path, config);
    if (!recording.ok()) return recording.status();
    return MakeRecordingSource(path, std::move(recording.value()), config, CameraBeside(path));
}

}  // namespace tessera
