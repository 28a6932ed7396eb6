#include "optimize/frame_store.h"

#include <fmt/format.h>
#include <tbb/parallel_invoke.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "io/jpeg_decoder.h"
#include "io/jpeg_encoder.h"

namespace tessera {
namespace {

constexpr int kJpegQuality = 92, kMaxSide_px = 65500;

}  // namespace

Status FrameStore::Add(const Frame& frame, int keyframe, bool is_keyframe,
                       const Eigen::Isometry3d& T_keyframe_camera, const Integrator::View& view) {
    if (Status stored = StoreAverage(); !stored.ok()) return stored;
    return Store(frame, keyframe, is_keyframe, T_keyframe_camera, view);
}

Status FrameStore::AddAveraged(const Frame& frame, const PinholeCamera& camera, int keyframe,
                               const Eigen::Isometry3d& T_keyframe_camera,
                               const Integrator::View& view) {
    if (average_.Add(frame, T_keyframe_camera, view)) return Status::Ok();
    if (Status stored = StoreAverage(); !stored.ok()) return stored;
    average_.Begin(frame, camera, T_keyframe_camera, view);
    keyframe_ = keyframe;
    return Status::Ok();
}

Status FrameStore::StoreAverage() {
    if (average_.empty()) return Status::Ok();
    return Store(average_.Take(), keyframe_, false, average_.T_keyframe_camera(), average_.view());
}

// A map without these frames is still a map.
void FrameStore::StoreLatest() {
    if (Status stored = StoreAverage(); !stored.ok()) trouble_ = stored.message();
}

std::string FrameStore::TakeTrouble() {
    return trouble_.empty() ? scratch_.TakeTrouble() : std::exchange(trouble_, {});
}

Status FrameStore::Store(const Frame& frame, int keyframe, bool is_keyframe,
                         const Eigen::Isometry3d& T_keyframe_camera, const Integrator::View& view) {
    const std::int64_t ordinal = next_ordinal_++;
    if (!is_keyframe && ordinal % stride_ != 0) return Status::Ok();
    StoredFrame stored{ordinal,     keyframe,      is_keyframe,          T_keyframe_camera,
                       view,        frame.stamp_s, frame.colour_stamp_s, {},
                       frame.index, std::nullopt};
    EncodedImages images;
    raw_depth_.Resize(frame.depth_m.width(), frame.depth_m.height());
    const float units = static_cast<float>(depth_units_per_m_);
    std::transform(frame.depth_m.data(), frame.depth_m.data() + frame.depth_m.size(),
                   raw_depth_.data(), [&](float z) {
                       return static_cast<std::uint16_t>(
                           z * units < 65535.0f ? std::lround(std::max(z, 0.0f) * units) : 0);
                   });
    Status encoded;
    tbb::parallel_invoke([&] { encoder_.EncodeDepth(raw_depth_, images.depth_png); },
                         [&] {
                             if (!frame.colour.empty() && view.colour_weight > 0)
                                 encoded =
                                     EncodeJpeg(frame.colour, kJpegQuality, images.colour_jpeg);
                         });
    if (!encoded.ok()) return encoded;
    stored.images = scratch_.Keep(std::move(images));
    bytes_ += stored.memory_bytes();
    frames_.push_back(std::move(stored));
    ThinToLimit();
    return Status::Ok();
}

const StoredFrame* FrameStore::Find(std::int64_t frame_index) const {
    const auto own = std::ranges::lower_bound(frames_, first_own_, {}, &StoredFrame::ordinal);
    const auto frame =
        std::ranges::lower_bound(own, frames_.end(), frame_index, {}, &StoredFrame::frame_index);
    return frame != frames_.end() && frame->frame_index == frame_index ? &*frame : nullptr;
}

void FrameStore::AddDetections(std::int64_t frame_index, std::vector<Detection> detections,
                               const ClassSet& ignored) {
    const StoredFrame* found = Find(frame_index);
    if (found == nullptr) return;
    StoredFrame& frame = frames_[static_cast<std::size_t>(found - frames_.data())];
    bytes_ -= frame.memory_bytes();
    frame.detections.emplace(std::move(detections), ignored);
    bytes_ += frame.memory_bytes();
    ThinToLimit();
}

void FrameStore::Resume(std::vector<StoredFrame> frames, std::int64_t next_ordinal) {
    frames_ = std::move(frames);
    next_ordinal_ = first_own_ = next_ordinal;
    for (const StoredFrame& f : frames_) bytes_ += f.memory_bytes();
    ThinToLimit();
}

void FrameStore::ThinToLimit() {
    while (bytes_ > limit_bytes_ && stride_ < (1 << 20)) Thin();
}

void FrameStore::Thin() {
    stride_ *= 2;
    std::erase_if(frames_,
                  [&](const StoredFrame& f) { return !f.is_keyframe && f.ordinal % stride_ != 0; });
    bytes_ = 0;
    for (const StoredFrame& f : frames_) bytes_ += f.memory_bytes();
}

Status FrameStore::Load(const StoredFrame& stored, Frame& frame) {
    frame.index = stored.ordinal;
    const auto read = stored.images.Read();
    if (!read.ok()) return read.status();
    return Decode(*read.value(), frame);
}

Status FrameStore::Decode(const EncodedImages& images, Frame& frame) {
    Status depth = Status::Ok(), colour = Status::Ok();
    const auto decode_colour = [&] {
        if (images.colour_jpeg.empty())
            frame.colour = {};
        else
            colour = DecodeJpeg(images.colour_jpeg, kMaxSide_px, frame.colour);
    };
    tbb::parallel_invoke([&] { depth = DecodeDepth(images.depth_png, frame.depth_m); },
                         decode_colour);
    return depth.ok() ? colour : depth;
}

Status FrameStore::DecodeDepth(const std::vector<std::uint8_t>& png, DepthImage& depth_m) {
    const auto header = ReadPngHeader(png);
    if (!header) return Status::Error("a stored depth image is not a PNG file");
    if (Status status = decoder_.DecodeDepth(png, *header, raw_depth_); !status.ok()) return status;
    depth_m.Resize(raw_depth_.width(), raw_depth_.height());
    const float metres = static_cast<float>(1 / depth_units_per_m_);
    std::transform(raw_depth_.data(), raw_depth_.data() + raw_depth_.size(), depth_m.data(),
                   [&](std::uint16_t raw) { return static_cast<float>(raw) * metres; });
    return Status::Ok();
}

Status FrameStore::LoadPrepared(const StoredFrame& stored, const PinholeCamera& camera,
                                const PreparedFrame::Config& preparation, Frame& frame,
                                PreparedFrame& prepared) {
    if (Status status = Load(stored, frame); !status.ok()) return status;
    const auto fits = [&](const auto& image) {
        return image.width() == camera.width && image.height() == camera.height;
    };
    if (!fits(frame.depth_m) || (!frame.colour.empty() && !fits(frame.colour)))
        return Status::Error(fmt::format(
            "stored frame {}: its image size differs from the camera's", stored.ordinal));
    PrepareFrame(frame, preparation, prepared);
    return Status::Ok();
}

}  // namespace tessera
