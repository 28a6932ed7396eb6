#include "io/frame_recorder.h"

#include <fcntl.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>

#include "io/file.h"
#include "io/image_io.h"
#include "io/jpeg_encoder.h"
#include "io/trajectory.h"

namespace tessera {

void RecordConfig::Describe(ConfigParameters& p) {
    p.AddChoice("colour", colour, {{"jpeg", Colour::kJpeg}, {"png", Colour::kPng}},
                "how recordings store colour: jpeg (quality 95, about 0.1 MB per frame) or png "
                "(exact, about 0.35 MB per frame and twice the time); .oni files store jpeg or "
                "uncompressed colour; depth is always exact");
}

Result<std::unique_ptr<FrameRecorder>> FrameRecorder::Create(const std::string& folder,
                                                             const SourceInfo& source,
                                                             const RecordConfig& config) {
    std::unique_ptr<FrameRecorder> recorder(new FrameRecorder(folder, source, config));
    if (Status status = recorder->Start(); !status.ok()) return status;
    return recorder;
}

Status FrameRecorder::Start() {
    if (!source_.has_colour)
        return Status::Error(
            fmt::format("{}: cannot be recorded: it has no colour, which a recorded folder needs",
                        source_.name));
    std::error_code ignored;
    for (const char* name : {"/depth.txt", "/rgb.txt", "/camera.yaml"})
        if (std::filesystem::exists(folder_ + name, ignored))
            return Status::Error(folder_ +
                                 ": already contains a recording; give a new folder name");
    for (const char* name : {"/rgb", "/depth"})
        if (Status status = PrepareOutputFolder(folder_ + name); !status.ok()) return status;
    const CameraCalibration camera{source_.camera, {}, source_.depth_units_per_m, source_.fps};
    const std::string header = "# timestamp filename\n";
    if (Status status = FirstError({WriteTextFile(folder_ + "/camera.yaml", CameraFileText(camera)),
                                    colour_list_.Open(folder_ + "/rgb.txt"),
                                    depth_list_.Open(folder_ + "/depth.txt")});
        !status.ok())
        return status;
    return FirstError({colour_list_.Append(header), depth_list_.Append(header)});
}

Status FrameRecorder::Add(const Frame& frame) {
    if (!status_.ok()) return status_;
    if (std::string why = WhyNot(frame); !why.empty()) return Status::Error(std::move(why));
    const std::string colour_name =
        fmt::format("rgb/{:.6f}.{}", frame.colour_stamp_s,
                    config_.colour == RecordConfig::Colour::kJpeg ? "jpg" : "png");
    const std::string depth_name = fmt::format("depth/{:.6f}.png", frame.stamp_s);
    Status status = WriteImages(frame, colour_name, depth_name);
    if (status.ok()) status = List(frame, colour_name, depth_name);
    if (!status.ok())
        return status_ = Status::Error(
                   fmt::format("{}; {} frames are safe in {}", status.message(), frames_, folder_));
    ++frames_;
    last_stamp_s_ = frame.stamp_s;
    last_colour_stamp_s_ = frame.colour_stamp_s;
    return status;
}

std::string FrameRecorder::WhyNot(const Frame& frame) const {
    const PinholeCamera& camera = source_.camera;
    const auto bad = [&](const std::string& why) {
        return fmt::format("{}: frame {} cannot be recorded: {}", source_.name, frame.index, why);
    };
    if (frame.colour.empty()) return bad("it has no colour");
    if (frame.depth_m.width() != camera.width || frame.depth_m.height() != camera.height ||
        frame.colour.width() != camera.width || frame.colour.height() != camera.height)
        return bad(fmt::format("its size is not the camera's {} x {} pixels", camera.width,
                               camera.height));
    // Compare as written: in microseconds.
    const auto increases = [&](double before_s, double stamp_s) {
        return frames_ == 0 ? std::isfinite(stamp_s)
                            : std::round(1e6 * stamp_s) > std::round(1e6 * before_s);
    };
    if (!increases(last_stamp_s_, frame.stamp_s) ||
        !increases(last_colour_stamp_s_, frame.colour_stamp_s))
        return bad("its time stamp is not later than the previous frame's");
    return {};
}

Status FrameRecorder::WriteImages(const Frame& frame, const std::string& colour_name,
                                  const std::string& depth_name) {
    if (config_.colour == RecordConfig::Colour::kPng)
        png_.EncodeColour(frame.colour, file_);
    else if (Status status = EncodeJpeg(frame.colour, kFineJpegQuality, file_); !status.ok())
        return Status::Error(folder_ + "/" + colour_name + ": " + status.message());
    if (Status status = WriteImage(colour_name); !status.ok()) return status;
    StoreDepth(frame.depth_m, source_.depth_units_per_m, depth_);
    png_.EncodeDepth(depth_, file_);
    return WriteImage(depth_name);
}

Status FrameRecorder::WriteImage(const std::string& name) const {
    AtomicFile file(folder_ + "/" + name);
    file.Write({reinterpret_cast<const char*>(file_.data()), file_.size()});
    return file.Commit(AtomicFile::Sync::kLater);
}

// Appends to the depth list last: a frame counts once it is listed there.
Status FrameRecorder::List(const Frame& frame, const std::string& colour_name,
                           const std::string& depth_name) {
    if (frame.T_world_camera) {
        if (!truth_.is_open())
            if (Status status = truth_.Open(folder_ + "/groundtruth.txt"); !status.ok())
                return status;
        if (Status status =
                truth_.Append(TrajectoryLine({frame.stamp_s, *frame.T_world_camera}) + '\n');
            !status.ok())
            return status;
    }
    if (Status status =
            colour_list_.Append(fmt::format("{:.6f} {}\n", frame.colour_stamp_s, colour_name));
        !status.ok())
        return status;
    return depth_list_.Append(fmt::format("{:.6f} {}\n", frame.stamp_s, depth_name));
}

Status FrameRecorder::Finish() {
    if (!status_.ok()) return status_;
    if (const int folder = open(folder_.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC); folder >= 0) {
        (void)syncfs(folder);  // flushes the images; the Sync calls below report a failing disk
        close(folder);
    }
    status_ = FirstError(
        {colour_list_.Sync(), depth_list_.Sync(), truth_.is_open() ? truth_.Sync() : Status::Ok()});
    return status_;
}

}  // namespace tessera
