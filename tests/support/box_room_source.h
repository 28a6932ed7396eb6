// The box room as a frame source, painted in warm colours.
#pragma once

#include <functional>

#include "io/frame_source.h"
#include "support/box_room.h"

namespace tessera::testing_support {

class BoxRoomSource : public FrameSource {
  public:
    struct Options {
        std::int64_t count = -1;  // -1: endless
        bool live = false;        // reports itself as a live device
        double speed = 1;         // speed factor of the camera motion
        // If this returns anything but kOk, Read returns it in place of the frame with that index.
        // May block.
        std::function<ReadResult(std::int64_t index)> before_read = {};
    };

    BoxRoomSource() : BoxRoomSource(Options()) {}
    explicit BoxRoomSource(const Options& options) : options_(options) {
        info_.name = "box room";
        info_.camera = SmallCamera();
        info_.frame_count = options.count;
        info_.live = options.live;
        info_.has_truth = true;
        room_.has_ball = true;
    }
    const SourceInfo& info() const override { return info_; }
    ReadResult Read(Frame& frame) override {
        if (next_ == options_.count) return {ReadStatus::kEnd, {}};
        if (options_.before_read)
            if (ReadResult result = options_.before_read(next_); result.status != ReadStatus::kOk) {
                if (result.status == ReadStatus::kSkip) ++next_;
                return result;
            }
        frame = room_.Render(SmallCamera(), SmoothPath(static_cast<int>(next_), options_.speed),
                             static_cast<double>(next_) / 30);
        frame.index = next_++;
        for (std::size_t i = 0; i < frame.colour.size(); ++i) {
            Rgb8& c = frame.colour.data()[i];
            c = {c.r, static_cast<std::uint8_t>(c.g * 7 / 10),
                 static_cast<std::uint8_t>(c.b * 4 / 10)};
        }
        return {};
    }
    bool Seek(std::int64_t index) override {
        next_ = index;
        return true;
    }

  private:
    Options options_;
    SourceInfo info_;
    BoxRoom room_;
    std::int64_t next_ = 0;
};

}  // namespace tessera::testing_support
