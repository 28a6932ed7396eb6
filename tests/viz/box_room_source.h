// The exact little world of the pipeline's tests as a source, painted in warm colours.
#pragma once

#include "io/frame_source.h"
#include "support/box_room.h"

namespace tessera::testing_support {

class BoxRoomSource : public FrameSource {
  public:
    BoxRoomSource() {
        info_.name = "box room";
        info_.camera = SmallCamera();
        room_.has_ball = true;
    }
    const SourceInfo& info() const override { return info_; }
    ReadResult Read(Frame& frame) override {
        frame = room_.Render(SmallCamera(), SmoothPath(static_cast<int>(next_)), static_cast<double>(next_) / 30);
        frame.index = next_++;
        for (std::size_t i = 0; i < frame.colour.size(); ++i) {
            Rgb8& c = frame.colour.data()[i];
            c = {c.r, static_cast<std::uint8_t>(c.g * 7 / 10), static_cast<std::uint8_t>(c.b * 4 / 10)};
        }
        return {};
    }
    bool Seek(std::int64_t index) override {
        next_ = index;
        return true;
    }

  private:
    SourceInfo info_;
    BoxRoom room_;
    std::int64_t next_ = 0;
};

}  // namespace tessera::testing_support
