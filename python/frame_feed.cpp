#include "frame_feed.h"

#include "core/check.h"

namespace tessera::python {

void FrameFeed::Push(Frame frame) {
    TESSERA_CHECK(frames_.TryPush(std::move(frame)), "the previous frame was not read");
}

void FrameFeed::Close() {
    closed_.store(true);
    wake_.Notify();
}

bool FrameFeed::Pop(Frame& frame) {
    bool popped = false;
    wake_.Wait([&] {
        popped = frames_.TryPop(frame);
        return popped || closed_.load();
    });
    return popped;
}

ReadResult FeedSource::Read(Frame& frame) {
    return {feed_->Pop(frame) ? ReadStatus::kOk : ReadStatus::kEnd, {}};
}

}  // namespace tessera::python
