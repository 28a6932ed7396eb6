#include "viz/frame_images.h"

#include <algorithm>

#include "viz/colour_map.h"

namespace tessera {

FrameImages::FrameImages(Open open)
    : open_(std::move(open)),
      reader_(1, [this](std::int64_t& index) { images_.Push(Read(index)); },
              {.low_priority = true}) {}

void FrameImages::Request(std::int64_t index) { reader_.PushNewest(std::int64_t{index}); }

std::optional<FrameImages::Image> FrameImages::Take() {
    Image image;
    if (!images_.TryPop(image)) return std::nullopt;
    return image;
}

FrameImages::Image FrameImages::Read(std::int64_t index) {
    constexpr int kWidth_px = 320;
    if (!opened_) {
        opened_ = true;
        Result<std::unique_ptr<FrameSource>> source = open_();
        if (source.ok() && !source.value()->info().live) source_ = std::move(source.value());
    }
    Image image{index, {}};
    Frame frame;
    if (!source_ || !source_->Seek(index) || source_->Read(frame).status != ReadStatus::kOk ||
        frame.index != index || frame.colour.empty())
        return image;
    const int step = std::max(1, (frame.colour.width() + kWidth_px - 1) / kWidth_px);
    image.colour = ShrinkColour(frame.colour, step);
    return image;
}

}  // namespace tessera
