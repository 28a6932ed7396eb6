#include "export/image_set.h"

#include <fmt/format.h>

#include <filesystem>

#include "core/frame.h"
#include "io/file.h"
#include "optimize/frame_store.h"

namespace tessera {

Result<std::unique_ptr<PosedFrames>> PosedFrames::Open(const std::string& scan_path) {
    auto frames = std::make_unique<PosedFrames>();
    Result<std::unique_ptr<ScanFile>> file = ScanFile::OpenToRead(scan_path);
    if (!file.ok()) return file.status();
    frames->file_ = std::move(file.value());
    Result<ScanContent> scan = ReadScan(*frames->file_, {.map = false});
    if (!scan.ok()) return scan.status();
    frames->scan_ = std::move(scan.value());
    if (frames->file_->seal().tables[IndexOf(ScanTable::kFrames)].rows == 0)
        return Status::Error(
            scan_path + ": contains no raw frames; scan with --set scan.frames=all to keep them");
    return frames;
}

Status PosedFrames::ForEach(const std::function<Status(const PosedFrame&)>& take) {
    FrameStore decoder(0, scan_.meta.depth_units_per_m);
    Frame frame;
    std::int64_t rows = 0, taken = 0, damaged = 0;
    std::string first_damaged;
    const auto leave_out = [&](std::int64_t key, const std::string& why) {
        if (damaged++ == 0)
            first_damaged = fmt::format("{}: frame {}: {}", file_->path(), key, why);
        return Status::Ok();
    };
    const auto fits = [this](const auto& image) {
        return image.width() == camera().width && image.height() == camera().height;
    };
    Status read = file_->Read(ScanTable::kFrames, [&](const ScanRow& row) {
        ++rows;
        FrameRecord record;
        if (row.key < 0 || row.key >= static_cast<std::int64_t>(scan_.path.size()) ||
            !record.Decode(row.data))
            return leave_out(row.key, "is damaged");
        const auto T_world_camera = scan_.PoseOf(scan_.path[static_cast<std::size_t>(row.key)]);
        const auto images = record.stored.images.Read();
        if (!images.ok()) return images.status();
        if (!T_world_camera || images.value()->colour_jpeg.empty()) return Status::Ok();
        if (Status status = decoder.Decode(*images.value(), frame); !status.ok())
            return leave_out(row.key, status.message());
        if (!fits(frame.depth_m) || !fits(frame.colour))
            return leave_out(row.key, "does not have the camera's size");
        ++taken;
        return take(
            {fmt::format("{:06}", row.key), *T_world_camera, images.value(), frame.depth_m});
    });
    if (!read.ok()) return read;
    if (taken == 0 && damaged > 0)
        return Status::Error(first_damaged + "; no frame can be exported");
    if (taken == 0)
        return Status::Error(
            file_->path() +
            ": none of its raw frames has both a pose and colour; scan again with a colour camera");
    notes_.clear();
    if (damaged > 0)
        notes_.push_back(
            fmt::format("{} of {} frames are left out ({})", damaged, rows, first_damaged));
    return Status::Ok();
}

Status MakeImageFolder(const std::string& path) {
    std::error_code ignored;
    if (std::filesystem::is_directory(path, ignored) && !std::filesystem::is_empty(path, ignored))
        return Status::Error(path + ": already contains files; give another location");
    return PrepareOutputFolder(path);
}

Status WriteImageFile(const std::string& path, std::span<const std::uint8_t> bytes) {
    AtomicFile file(path);
    file.Write({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
    return file.Commit(AtomicFile::Sync::kLater);
}

TriangleMesh SamplePoints(const TriangleMesh& mesh, std::size_t count) {
    TriangleMesh points;
    const std::size_t have = mesh.vertices.size(), wanted = std::min(count, have);
    for (std::size_t i = 0; i < wanted; ++i) {
        const std::size_t k = i * have / wanted;
        points.vertices.push_back(mesh.vertices[k]);
        points.colours.push_back(mesh.colours.empty() ? Rgb8{128, 128, 128} : mesh.colours[k]);
    }
    return points;
}

}  // namespace tessera
