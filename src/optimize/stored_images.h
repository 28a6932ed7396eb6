// Encoded images of frames, in a temporary file instead of in memory.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/status.h"
#include "io/temporary_file.h"

namespace tessera {

struct EncodedImages {
    std::vector<std::uint8_t> depth_png, colour_jpeg;  // colour_jpeg is empty without colour

    std::size_t bytes() const { return depth_png.size() + colour_jpeg.size(); }
};

// The images of one frame, wherever they are. Copies share them; any thread may read them.
class StoredImages {
  public:
    StoredImages() = default;  // none
    // In memory.
    explicit StoredImages(EncodedImages images)
        : held_(std::make_shared<const EncodedImages>(std::move(images))) {}

    // Returns an error if the temporary file cannot be read.
    Result<std::shared_ptr<const EncodedImages>> Read() const;
    std::size_t memory_bytes() const { return held_ ? held_->bytes() : 0; }

  private:
    friend class ImageScratch;
    struct Place;

    std::shared_ptr<const EncodedImages> held_;
    std::shared_ptr<const Place> place_;  // of images in a file; null otherwise
};

// Owner thread only. The images that it keeps outlive it.
class ImageScratch {
  public:
    // The file is made in this folder when it is needed first.
    explicit ImageScratch(std::string folder = TemporaryFolder()) : folder_(std::move(folder)) {}

    // Moves the images to the file. They stay in memory if it cannot be written, or if less than
    // kReserve_bytes would be left on its disk.
    StoredImages Keep(EncodedImages images);
    // Returns once why images are kept in memory; usually empty.
    std::string TakeTrouble();

    static constexpr std::uint64_t kReserve_bytes = std::uint64_t{256} << 20;

  private:
    Result<StoredImages> Write(const EncodedImages& images);

    std::string folder_;
    std::shared_ptr<TemporaryFile> file_;
    std::uint64_t end_ = 0;
    std::string trouble_;
    bool told_ = false;
};

}  // namespace tessera
