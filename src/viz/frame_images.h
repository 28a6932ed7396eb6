// The colour images of a finished run's source, one at a time and only when asked for. A thread of
// its own opens the source and reads.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>

#include "core/image.h"
#include "core/queue.h"
#include "core/worker.h"
#include "io/frame_source.h"

namespace tessera {

// Owner thread only.
class FrameImages {
  public:
    using Open = std::function<Result<std::unique_ptr<FrameSource>>()>;
    struct Image {
        std::int64_t index = -1;
        ColourImage colour;  // at most 320 pixels wide; empty: that frame has no image
    };

    // `open` is called once, on the thread, at the first request. If it fails, or the source cannot
    // seek, there are no images.
    explicit FrameImages(Open open);

    // Of the source's list. A newer request replaces one that waits.
    void Request(std::int64_t index);
    // The newest image, if one has arrived since the last call.
    std::optional<Image> Take();

  private:
    Image Read(std::int64_t index);

    const Open open_;
    bool opened_ = false;                  // this and the next: on the thread
    std::unique_ptr<FrameSource> source_;  // null: none
    Wake taken_;
    NewestQueue<Image> images_{1, taken_};
    Worker<std::int64_t, NewestQueue> reader_;
};

}  // namespace tessera
