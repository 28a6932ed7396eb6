// What the folders of phone scanning apps have in common: colour and depth of one camera in two
// image sizes, image files with numbers as names, and a confidence of each depth value.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/camera.h"
#include "core/image.h"
#include "core/status.h"
#include "io/image_decoder.h"
#include "recordings/recording.h"

namespace tessera {

// The same view in another image size. Both images cover the same area.
PinholeCamera ScaledTo(const PinholeCamera& camera, int width, int height);

// Sets both cameras of `info`, for depth in millimetres that covers what the colour camera sees. An
// error if the images have another shape, as when one of the two was turned.
Status SetPhoneCameras(const PinholeCamera& colour, ImageSize depth, RecordingInfo& info);

// Sets depth to 0 where the confidence is below `least`. An error if the sizes differ; depth is
// then as it was.
Status RemoveUnsure(const Image<std::uint8_t>& confidence, int least, Image<std::uint16_t>& depth);
// The same from a grey image that was read as colour.
Status RemoveUnsure(const ColourImage& confidence, int least, Image<std::uint16_t>& depth);

struct NumberedFile {
    std::uint64_t number = 0;
    std::string name;
    bool operator==(const NumberedFile&) const = default;
};

// The files called number.extension, by number; "1" and "01" count once. `extension` is without
// the dot. None if there is no such folder.
std::vector<NumberedFile> NumberedFiles(const std::string& folder, std::string_view extension);

// "subfolder/name" of the file with that number; empty if `files`, sorted by number, has none.
std::string NameOfNumber(const std::string& subfolder, const std::vector<NumberedFile>& files,
                         std::uint64_t number);

// A depth image and its confidence; empty if it has none.
struct PhoneDepth {
    std::uint64_t number = 0;
    std::string depth, confidence;
};

// The depth images by number. Says in `info` which of their depth PhoneImages removes.
std::vector<PhoneDepth> FindPhoneDepth(const std::string& folder, const std::string& depth,
                                       const std::string& confidence, RecordingInfo& info);

// Reads images of a folder. Keeps its buffers between images. Owner thread only. Never throws.
// Errors name the file as it is called within the folder.
class PhoneImages {
  public:
    explicit PhoneImages(std::string folder) : folder_(std::move(folder)) {}

    // Of the first of `names` that can be read; the error is the first file's.
    Result<ImageSize> FirstSize(const std::vector<std::string>& names);
    Status ReadColour(const std::string& name, ColourImage& image);
    // Without the depth whose confidence is 0, the lowest.
    Status ReadDepth(const PhoneDepth& names, Image<std::uint16_t>& depth);

  private:
    std::string PathOf(const std::string& name) const { return folder_ + "/" + name; }
    Status WithoutFolder(const Status& status) const;

    std::string folder_;
    ImageDecoder decoder_;
    ColourImage confidence_;
};

}  // namespace tessera
