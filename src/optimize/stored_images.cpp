#include "optimize/stored_images.h"

#include <utility>

namespace tessera {

// A range of the file, given back to the disk with the last copy of the images.
struct StoredImages::Place {
    Place(std::shared_ptr<TemporaryFile> in, std::uint64_t at, const EncodedImages& images)
        : file(std::move(in)),
          offset(at),
          depth_bytes(images.depth_png.size()),
          colour_bytes(images.colour_jpeg.size()) {}
    ~Place() { file->Discard(offset, depth_bytes + colour_bytes); }
    Place(const Place&) = delete;
    Place& operator=(const Place&) = delete;

    const std::shared_ptr<TemporaryFile> file;
    const std::uint64_t offset;
    const std::size_t depth_bytes, colour_bytes;
};

Result<std::shared_ptr<const EncodedImages>> StoredImages::Read() const {
    auto images = std::make_shared<EncodedImages>();
    if (!place_) return held_ ? held_ : std::shared_ptr<const EncodedImages>(std::move(images));
    images->depth_png.resize(place_->depth_bytes);
    images->colour_jpeg.resize(place_->colour_bytes);
    Status read = place_->file->Read(images->depth_png, place_->offset);
    if (read.ok())
        read = place_->file->Read(images->colour_jpeg, place_->offset + place_->depth_bytes);
    if (!read.ok()) return Status::Error("the temporary file of frames " + read.message());
    return std::shared_ptr<const EncodedImages>(std::move(images));
}

StoredImages ImageScratch::Keep(EncodedImages images) {
    Result<StoredImages> written = Write(images);
    if (written.ok()) return std::move(written.value());
    if (!told_) trouble_ = written.message();
    told_ = true;
    images.depth_png.shrink_to_fit();
    images.colour_jpeg.shrink_to_fit();
    return StoredImages(std::move(images));
}

Result<StoredImages> ImageScratch::Write(const EncodedImages& images) {
    if (!file_) {
        Result<std::shared_ptr<TemporaryFile>> file =
            TemporaryFile::CreateBeside(folder_ + "/tessera-frames");
        if (!file.ok()) return file.status();
        file_ = std::move(file.value());
    }
    if (file_->FreeOnDisk() < kReserve_bytes + images.bytes())
        return Status::Error(folder_ +
                             ": less than 256 MB are free; free some space or set TMPDIR");
    Status written = file_->Write(images.depth_png, end_);
    if (written.ok()) written = file_->Write(images.colour_jpeg, end_ + images.depth_png.size());
    if (!written.ok())
        return Status::Error(folder_ + ": the temporary file of frames " + written.message());
    StoredImages stored;
    stored.place_ = std::make_shared<StoredImages::Place>(file_, end_, images);
    end_ += images.bytes();
    return stored;
}

std::string ImageScratch::TakeTrouble() {
    if (trouble_.empty()) return {};
    return "frames for corrected maps are kept in memory: " + std::exchange(trouble_, {});
}

}  // namespace tessera
