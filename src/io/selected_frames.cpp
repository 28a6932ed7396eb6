#include "io/selected_frames.h"

#include <limits>

#include "core/check.h"

namespace tessera {
namespace {

bool IsFinal(const ReadResult& result) {
    return result.status == ReadStatus::kEnd || result.status == ReadStatus::kError;
}

ReadResult CheckSelection(const FrameSelection& selection, const SourceInfo& info) {
    const auto error = [&](std::string why) {
        return ReadResult{ReadStatus::kError, info.name + ": " + std::move(why)};
    };
    if (selection.start < 0)
        return error(fmt::format("start frame {} is negative", selection.start));
    if (selection.stride < 1)
        return error(fmt::format("stride {} is less than 1", selection.stride));
    if (selection.count < -1)
        return error(fmt::format("{} frames cannot be read", selection.count));
    if (info.frame_count >= 0 && selection.start >= info.frame_count)
        return error(fmt::format("start frame {} is past the end of its {} frames", selection.start,
                                 info.frame_count));
    return {};
}

}  // namespace

SelectedFrames::SelectedFrames(std::unique_ptr<FrameSource> source, const FrameSelection& selection)
    : source_(std::move(source)),
      selection_(selection),
      final_(CheckSelection(selection, source_->info())) {}

ReadResult SelectedFrames::Next(Frame& frame) {
    if (IsFinal(final_)) return final_;
    ReadResult result{ReadStatus::kEnd, {}};
    if (selection_.count < 0 || given_ < selection_.count) result = Advance(frame);
    if (IsFinal(result)) final_ = result;
    return result;
}

ReadResult SelectedFrames::Advance(Frame& frame) {
    constexpr std::int64_t kLast = std::numeric_limits<std::int64_t>::max();
    if (given_ >= (kLast - selection_.start) / selection_.stride) return {ReadStatus::kEnd, {}};
    const std::int64_t wanted = selection_.start + given_ * selection_.stride;
    const std::int64_t count = source_->info().frame_count;
    if (count >= 0 && wanted >= count) return {ReadStatus::kEnd, {}};
    if (position_ != wanted && source_->Seek(wanted)) position_ = wanted;
    for (; position_ < wanted; ++position_)
        if (ReadResult dropped = source_->Read(frame);
            IsFinal(dropped) || dropped.status == ReadStatus::kWait)
            return dropped;
    ReadResult result = source_->Read(frame);
    if (result.status == ReadStatus::kWait) return result;
    ++position_;
    ++given_;
    if (result.status == ReadStatus::kOk && !order_.Accepts(frame.stamp_s))
        return {ReadStatus::kSkip,
                fmt::format("{}: frame {}: its time stamp, {:.3f} s, is before that of the frame "
                            "before it, {:.3f} s",
                            source_->info().name, frame.index, frame.stamp_s, order_.last_s())};
    return result;
}

}  // namespace tessera
