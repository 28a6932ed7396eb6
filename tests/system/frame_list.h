// A source that returns a given list of frames at 30 Hz.
#pragma once

#include "io/frame_source.h"
#include "optimize/room_walk.h"

namespace tessera::testing_support {

class FrameList : public FrameSource {
  public:
    explicit FrameList(std::vector<Frame> frames, double first_stamp_s = 0)
        : frames_(std::move(frames)) {
        info_.name = "frames";
        info_.camera = RoomCamera();
        for (std::size_t i = 0; i < frames_.size(); ++i) {
            frames_[i].index = static_cast<std::int64_t>(i);
            frames_[i].stamp_s = frames_[i].colour_stamp_s =
                first_stamp_s + static_cast<double>(i) / 30;
        }
    }
    // From this frame on, they are a second apart.
    void SlowDown(std::size_t from) {
        for (std::size_t i = from; i < frames_.size(); ++i)
            frames_[i].stamp_s = frames_[i].colour_stamp_s =
                frames_[from - 1].stamp_s + static_cast<double>(i - from + 1);
    }
    const SourceInfo& info() const override { return info_; }
    ReadResult Read(Frame& frame) override {
        if (next_ == frames_.size()) return {ReadStatus::kEnd, {}};
        frame = frames_[next_++];
        return {};
    }
    bool Seek(std::int64_t) override { return false; }
    Status RecordTo(const std::string&, bool) override { return Status::Error("no"); }

  private:
    std::vector<Frame> frames_;
    SourceInfo info_;
    std::size_t next_ = 0;
};

inline Frame Blank() {
    Frame frame;
    frame.colour = ColourImage(320, 240);
    frame.depth_m = DepthImage(320, 240, 0.0f);
    return frame;
}

}  // namespace tessera::testing_support
