// The colour video of a phone recording, frame by frame. Frames are counted while they are decoded,
// so that a number means the same frame whatever was read before.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "core/image.h"
#include "core/status.h"

namespace tessera {

// Owner thread only. Never throws. Content is not trusted.
class StrayVideo {
  public:
    // An MP4 or MOV file; errors name it. The orientation that it stores is ignored: depth is not
    // turned either.
    static Result<StrayVideo> Open(const std::string& path);

    int width() const { return width_; }                       // pixels, at most 8192
    int height() const { return height_; }                     // pixels, at most 8192
    std::int64_t frame_count() const { return frame_count_; }  // as the file claims; 0: unknown
    double fps() const { return fps_; }                        // as the file claims; 0: unknown

    // Forwards passes over the frames between; backwards starts again, which takes as long as
    // decoding all frames before. Errors do not name the file.
    Status Read(std::uint64_t index, ColourImage& image);

    ~StrayVideo();
    StrayVideo(StrayVideo&&) noexcept;
    StrayVideo& operator=(StrayVideo&&) noexcept;

  private:
    explicit StrayVideo(std::string path);
    Status Start();
    Status ReadFrame(std::uint64_t index, ColourImage& image);

    std::string path_;
    struct Decoder;
    std::unique_ptr<Decoder> decoder_;
    std::uint64_t next_ = 0;  // the frame that is decoded next
    bool ended_ = false;      // before frame next_
    int width_ = 0, height_ = 0;
    std::int64_t frame_count_ = 0;
    double fps_ = 0;
};

}  // namespace tessera
