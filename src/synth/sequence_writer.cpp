#include "synth/sequence_writer.h"

#include <fmt/format.h>
#include <oneapi/tbb/parallel_invoke.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <vector>

#include "io/file.h"
#include "io/image_io.h"
#include "io/mesh_io.h"
#include "io/trajectory.h"
#include "synth/seen_objects.h"

namespace tessera {
namespace {

constexpr double kDepthScale = 5000;  // stored value per metre
constexpr float kFarthestStored_m = static_cast<float>(65535 / kDepthScale);

ColourImage Grey(const Image<Mobility>& mobility) {
    ColourImage grey(mobility.width(), mobility.height());
    std::transform(mobility.data(), mobility.data() + mobility.size(), grey.data(), [](Mobility m) {
        const auto level = static_cast<std::uint8_t>(m);
        return Rgb8{level, level, level};
    });
    return grey;
}

// A sequence has folders for labels and instances from the beginning, unlike a recording and a run.
Status CheckSequenceFolder(const std::string& folder) {
    namespace fs = std::filesystem;
    std::error_code ignored;
    if (fs::is_directory(folder + "/labels", ignored) &&
        fs::is_directory(folder + "/instances", ignored))
        return Status::Ok();
    for (const char* name :
         {"rgb", "depth", "labels", "instances", "moving", "rgb.txt", "depth.txt", "camera.yaml",
          "groundtruth.txt", "classes.txt", "objects.json", "detections.txt", "reference.ply"})
        if (fs::exists(folder + "/" + name, ignored))
            return Status::Error(
                fmt::format("{}/{}: would be replaced, but is not of a synthetic sequence; move it "
                            "away, or give another folder",
                            folder, name));
    return Status::Ok();
}

// Depth noise stays below this share of the depth; steps at discontinuities exceed it.
constexpr float kSameSurface = 0.03f;

class Writer {
  public:
    Writer(SyntheticSource& source, const std::string& folder)
        : source_(source),
          folder_(folder),
          objects_(source.scene(), static_cast<std::uint64_t>(source.config().seed)),
          seen_patches_(static_cast<std::size_t>(source.scene().patch_count())) {}

    Status PrepareFolders() const {
        for (const char* name : {"rgb", "depth", "labels", "instances", "moving"})
            if (Status status = name != std::string("moving") || source_.scene().has_motion()
                                    ? PrepareOutputFolder(folder_ + "/" + name)
                                    : Status::Ok();
                !status.ok())
                return status;
        return Status::Ok();
    }
    Status WriteImages(const Frame& frame, const RenderedView& truth);
    void Remember(const Frame& frame, const RenderedView& truth);
    Status WriteLists() const;
    SequenceSummary Summary(std::int64_t reference_triangles) const;
    TriangleMesh Reference() const { return source_.scene().PatchMesh(&seen_patches_); }

  private:
    SyntheticSource& source_;
    std::string folder_;
    SeenObjects objects_;
    std::vector<bool> seen_patches_;
    std::vector<StampedPose> poses_;
    std::string rgb_list_, depth_list_;
};

Status Writer::WriteImages(const Frame& frame, const RenderedView& truth) {
    const std::string file = fmt::format("/{:.6f}.png", frame.stamp_s);
    Image<std::uint16_t> depth;
    StoreDepth(frame.depth_m, kDepthScale, depth);
    std::array<Status, 5> done;
    tbb::parallel_invoke(
        [&] { done[0] = WriteColourImage(folder_ + "/rgb" + file, frame.colour); },
        [&] { done[1] = WriteDepthImage(folder_ + "/depth" + file, depth); },
        [&] { done[2] = WriteDepthImage(folder_ + "/labels" + file, truth.class_id); },
        [&] { done[3] = WriteDepthImage(folder_ + "/instances" + file, truth.instance); },
        [&] {
            if (source_.scene().has_motion())
                done[4] = WriteColourImage(folder_ + "/moving" + file, Grey(truth.mobility));
        });
    return FirstError({done[0], done[1], done[2], done[3], done[4]});
}

void Writer::Remember(const Frame& frame, const RenderedView& truth) {
    for (std::size_t i = 0; i < truth.patch.size(); ++i) {
        const float truth_m = truth.depth_m.data()[i], measured_m = frame.depth_m.data()[i];
        // At a ragged edge the sensor may measure a neighbouring surface. Then this surface was not
        // seen here.
        const bool is_this_surface = std::abs(measured_m - truth_m) < kSameSurface * truth_m;
        if (truth.patch.data()[i] >= 0 && is_this_surface && measured_m <= kFarthestStored_m)
            seen_patches_[static_cast<std::size_t>(truth.patch.data()[i])] = true;
    }
    objects_.Add(truth, frame.index, frame.stamp_s);
    poses_.push_back({frame.stamp_s, *frame.T_world_camera});
    rgb_list_ += fmt::format("{0:.6f} rgb/{0:.6f}.png\n", frame.stamp_s);
    depth_list_ += fmt::format("{0:.6f} depth/{0:.6f}.png\n", frame.stamp_s);
}

Status Writer::WriteLists() const {
    const std::string header = "# timestamp filename\n";
    const CameraCalibration camera{source_.info().camera, {}, kDepthScale, source_.info().fps};
    return FirstError({WriteTextFile(folder_ + "/rgb.txt", header + rgb_list_),
                       WriteTextFile(folder_ + "/depth.txt", header + depth_list_),
                       WriteTextFile(folder_ + "/camera.yaml", CameraFileText(camera)),
                       WriteTrajectory(folder_ + "/groundtruth.txt", poses_),
                       WriteTextFile(folder_ + "/classes.txt", objects_.ClassesText()),
                       WriteTextFile(folder_ + "/objects.json", objects_.ObjectsJson()),
                       WriteTextFile(folder_ + "/detections.txt", objects_.DetectionsText())});
}

SequenceSummary Writer::Summary(std::int64_t reference_triangles) const {
    SequenceSummary summary;
    summary.frames = static_cast<std::int64_t>(poses_.size());
    summary.reference_triangles = reference_triangles;
    for (std::size_t i = 1; i < poses_.size(); ++i)
        summary.path_m +=
            (poses_[i].T_world_camera.translation() - poses_[i - 1].T_world_camera.translation())
                .norm();
    return summary;
}

}  // namespace

Result<SequenceSummary> WriteSequence(SyntheticSource& source, const std::string& folder,
                                      const WriteProgress& progress) {
    if (Status status = CheckSequenceFolder(folder); !status.ok()) return status;
    Writer writer(source, folder);
    if (Status status = writer.PrepareFolders(); !status.ok()) return status;
    source.Seek(0);
    Frame frame;
    RenderedView truth;
    const std::int64_t total = source.info().frame_count;
    for (std::int64_t done = 0; source.ReadWithTruth(frame, truth).status == ReadStatus::kOk;) {
        if (Status status = writer.WriteImages(frame, truth); !status.ok()) return status;
        writer.Remember(frame, truth);
        if (progress && !progress(++done, total)) break;
    }
    const TriangleMesh reference = writer.Reference();
    if (Status status =
            FirstError({writer.WriteLists(), WritePly(folder + "/reference.ply", reference)});
        !status.ok())
        return status;
    return writer.Summary(static_cast<std::int64_t>(reference.triangles.size()));
}

}  // namespace tessera
