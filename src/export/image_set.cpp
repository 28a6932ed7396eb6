#include "export/image_set.h"

#include <fmt/format.h>

#include <filesystem>

#include "io/file.h"

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
    std::size_t taken = 0;
    Status read = file_->Read(ScanTable::kFrames, [&](const ScanRow& row) {
        FrameRecord record;
        if (row.key < 0 || row.key >= static_cast<std::int64_t>(scan_.path.size()) ||
            !record.Decode(row.data))
            return DamagedScan(file_->path(), fmt::format("frames {}", row.key));
        const auto T_world_camera = scan_.PoseOf(scan_.path[static_cast<std::size_t>(row.key)]);
        const auto images = record.stored.images.Read();
        if (!images.ok()) return images.status();
        if (!T_world_camera || images.value()->colour_jpeg.empty()) return Status::Ok();
        ++taken;
        return take({fmt::format("{:06}", row.key), *T_world_camera, images.value()});
    });
    if (!read.ok()) return read;
    if (taken == 0)
        return Status::Error(
            file_->path() +
            ": none of its raw frames has both a pose and colour; scan again with a colour camera");
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
