#include "io/frame_reader.h"

#include <exception>
#include <utility>

#include "core/check.h"
#include "core/stopwatch.h"

namespace tessera {
namespace {

std::size_t CheckedCapacity(int capacity) {
    TESSERA_CHECK(capacity >= 1, "capacity {}", capacity);
    return static_cast<std::size_t>(capacity);
}

bool EndsReading(const ReadResult& result) {
    return result.status == ReadStatus::kEnd || result.status == ReadStatus::kError;
}

}  // namespace

FrameReader::FrameReader(std::unique_ptr<FrameSource> source, const FrameSelection& selection,
                         int capacity)
    : frames_(std::move(source), selection),
      info_(frames_.info()),
      filled_(CheckedCapacity(capacity), taker_),
      worker_(filled_.capacity(), [this](std::unique_ptr<Slot>& slot) { Fill(std::move(slot)); }) {
    for (int i = 0; i < capacity; ++i) worker_.TryPush(std::make_unique<Slot>());
}

FrameReader::~FrameReader() { RequestStop(); }

void FrameReader::RequestStop() {
    stop_.store(true);
    taker_.Notify();
}

void FrameReader::Fill(std::unique_ptr<Slot> slot) {
    if (ended_ || stop_.load()) return;
    Stopwatch watch;
    slot->result = ReadInto(slot->frame);
    slot->decode_ms = watch.LapMs();
    ended_ = EndsReading(slot->result);
    TESSERA_CHECK(filled_.TryPush(std::move(slot)), "more slots than the capacity");
}

ReadResult FrameReader::ReadInto(Frame& frame) {
    try {
        return frames_.Next(frame);
    } catch (const std::exception& error) {  // out of memory; a source throws nothing else
        return {ReadStatus::kError, info_.name + ": reading failed: " + error.what()};
    }
}

ReadResult FrameReader::Next(Frame& frame) {
    std::unique_ptr<Slot> slot;
    if (!last_) taker_.Wait([&] { return stop_.load() || filled_.TryPop(slot); });
    if (stop_.load()) return {ReadStatus::kEnd, {}};
    if (last_) return last_->result;
    decode_ms_ = slot->decode_ms;
    if (EndsReading(slot->result)) {
        last_ = std::move(slot);
        return last_->result;
    }
    if (slot->result.status == ReadStatus::kOk) std::swap(frame, slot->frame);
    ReadResult result = std::move(slot->result);
    worker_.TryPush(std::move(slot));
    return result;
}

}  // namespace tessera
