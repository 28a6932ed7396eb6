#include "io/openni_camera.h"

#include <OpenNI.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>

#include "io/growing_file.h"
#include "io/openni_setup.h"

namespace tessera {

struct OpenniCamera::Streams {
    openni::Device device;
    openni::VideoStream depth, colour;
    openni::Recorder recorder;

    // The streams stop first: if an image arrives while the recorder is destroyed, the library may
    // wait for itself for ever.
    ~Streams() {
        for (openni::VideoStream* stream : {&depth, &colour})
            if (stream->isValid()) stream->stop();
        recorder.destroy();
        depth.destroy();
        colour.destroy();
        device.close();
    }
};

namespace {

constexpr int kDepthBytes = 2, kRgbBytes = 3;

int PixelBytes(openni::PixelFormat format) {
    return format == openni::PIXEL_FORMAT_RGB888  ? kRgbBytes
           : format == openni::PIXEL_FORMAT_GRAY8 ? 1
                                                  : kDepthBytes;
}

// Returns what is wrong with an image that should have the camera's size; empty if nothing is.
std::string FaultOf(const openni::VideoFrameRef& image, const PinholeCamera& camera) {
    if (image.getData() == nullptr || image.getDataSize() <= 0) return "it is empty";
    if (image.getWidth() != camera.width || image.getHeight() != camera.height)
        return fmt::format("it has {} x {} pixels instead of {} x {}", image.getWidth(),
                           image.getHeight(), camera.width, camera.height);
    const std::int64_t row =
        std::int64_t{camera.width} * PixelBytes(image.getVideoMode().getPixelFormat());
    const std::int64_t stride = image.getStrideInBytes();
    if (stride < row || image.getDataSize() < stride * (camera.height - 1) + row)
        return fmt::format("it has {} bytes, too few for its size", image.getDataSize());
    return {};
}

void CopyDepth(const openni::VideoFrameRef& from, Image<std::uint16_t>& to) {
    to.Resize(from.getWidth(), from.getHeight());
    const auto* row = static_cast<const std::uint8_t*>(from.getData());
    for (int y = 0; y < to.height(); ++y, row += from.getStrideInBytes())
        std::memcpy(to.row(y), row, static_cast<std::size_t>(to.width()) * kDepthBytes);
}

void CopyColour(const openni::VideoFrameRef& from, ColourImage& to) {
    to.Resize(from.getWidth(), from.getHeight());
    const auto* row = static_cast<const std::uint8_t*>(from.getData());
    const bool grey = from.getVideoMode().getPixelFormat() == openni::PIXEL_FORMAT_GRAY8;
    for (int y = 0; y < to.height(); ++y, row += from.getStrideInBytes()) {
        if (!grey)
            std::memcpy(static_cast<void*>(to.row(y)), row,
                        static_cast<std::size_t>(to.width()) * kRgbBytes);
        else
            for (int x = 0; x < to.width(); ++x) to(x, y) = {row[x], row[x], row[x]};
    }
}

Status StartPlayback(openni::Device& device, const openni::VideoStream& depth,
                     const openni::VideoStream& colour, const OpenniConfig& config,
                     OpenniCamera::About& about) {
    openni::PlaybackControl* playback = device.getPlaybackControl();
    if (playback == nullptr) return Status::Error("is not an .oni recording");
    // -1: deliver a frame whenever one is requested.
    const float speed = config.playback == OpenniConfig::Playback::kFast ? -1.0f : 1.0f;
    if (playback->setRepeatEnabled(false) != openni::STATUS_OK ||
        playback->setSpeed(speed) != openni::STATUS_OK)
        return Status::Error("cannot be played back: " + OpenniErrorText());
    const int frames =
        std::min(playback->getNumberOfFrames(depth), playback->getNumberOfFrames(colour));
    if (frames >= 0) about.frame_count = frames;
    return Status::Ok();
}

}  // namespace

OpenniCamera::OpenniCamera(std::shared_ptr<OpenniRuntime> runtime, std::unique_ptr<Streams> streams,
                           About about, bool is_recording)
    : runtime_(std::move(runtime)),
      streams_(std::move(streams)),
      about_(std::move(about)),
      is_recording_(is_recording) {}

OpenniCamera::~OpenniCamera() = default;

Result<std::unique_ptr<OpenniCamera>> OpenniCamera::Open(std::shared_ptr<OpenniRuntime> runtime,
                                                         const std::string& uri, bool is_recording,
                                                         const OpenniConfig& config) {
    About about;
    about.uri = uri;
    runtime->Watch(uri);
    auto streams = std::make_unique<Streams>();
    if (streams->device.open(uri.c_str()) != openni::STATUS_OK)
        return Status::Error(is_recording
                                 ? "is not a complete .oni recording (" + OpenniErrorText() + ")"
                                 : "cannot be opened; is another program using it? (" +
                                       OpenniErrorText() + ")");
    const openni::DeviceInfo& info = streams->device.getDeviceInfo();
    about.name = std::string(info.getVendor()) + " " + info.getName();
    char serial[64]{};
    int bytes = sizeof(serial) - 1;
    if (!is_recording && streams->device.getProperty(openni::DEVICE_PROPERTY_SERIAL_NUMBER, serial,
                                                     &bytes) == openni::STATUS_OK)
        about.serial = serial;
    const OpenniStreams parts{streams->device, streams->depth, streams->colour};
    if (Status status = SetUpOpenniStreams(parts, is_recording, config, about); !status.ok())
        return status;
    if (is_recording)
        if (Status status =
                StartPlayback(streams->device, streams->depth, streams->colour, config, about);
            !status.ok())
            return status;
    if (Status status = StartOpenniStreams(parts, is_recording, config, about); !status.ok())
        return status;
    return std::unique_ptr<OpenniCamera>(
        new OpenniCamera(std::move(runtime), std::move(streams), std::move(about), is_recording));
}

OpenniCamera::Arrival OpenniCamera::Wait(double seconds, Image<std::uint16_t>& depth,
                                         ColourImage& colour) {
    Arrival arrival;
    openni::VideoStream* both[] = {&streams_->depth, &streams_->colour};
    int ready = -1;
    const int milliseconds = std::max(1, static_cast<int>(std::lround(1000 * seconds)));
    openni::VideoFrameRef image;
    if (openni::OpenNI::waitForAnyStream(both, 2, &ready, milliseconds) != openni::STATUS_OK ||
        ready < 0 || both[ready]->readFrame(&image) != openni::STATUS_OK || !image.isValid()) {
        if (is_recording_ && runtime_->ReachedEnd(about_.uri)) arrival.event = Event::kEnd;
        return arrival;
    }
    const bool is_depth = ready == 0;
    arrival.event = is_depth ? Event::kDepth : Event::kColour;
    arrival.stamp_us = image.getTimestamp();
    arrival.number = image.getFrameIndex();
    arrival.fault = FaultOf(image, about_.camera);
    if (!arrival.fault.empty()) return arrival;
    if (is_depth)
        CopyDepth(image, depth);
    else
        CopyColour(image, colour);
    return arrival;
}

void OpenniCamera::StopFrameSync() {
    streams_->device.setDepthColorSyncEnabled(false);
    about_.frame_sync = false;
}

Status OpenniCamera::Record(const std::string& path, bool lossless_colour) {
    openni::Recorder& recorder = streams_->recorder;
    if (recorder.isValid()) return Status::Error(path + ": this camera is already being recorded");
    std::error_code ignored;
    if (std::filesystem::exists(path, ignored))
        return Status::Error(path + ": already exists; give a new name");
    // The library terminates the process if it cannot open the file, so test that first.
    if (GrowingFile probe; !probe.Open(path).ok()) return probe.Open(path);
    if (recorder.create(path.c_str()) != openni::STATUS_OK)
        return Status::Error(path + ": the recording cannot be started: " + OpenniErrorText());
    if (recorder.attach(streams_->depth, false) != openni::STATUS_OK ||
        recorder.attach(streams_->colour, !lossless_colour) != openni::STATUS_OK ||
        recorder.start() != openni::STATUS_OK) {
        recorder.destroy();
        return Status::Error(path + ": the recording cannot be started: " + OpenniErrorText());
    }
    return Status::Ok();
}

}  // namespace tessera
