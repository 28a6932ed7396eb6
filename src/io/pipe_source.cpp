#include "io/pipe_source.h"

#include <fmt/format.h>

#include <cstring>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "core/stopwatch.h"
#include "io/klg_frame.h"
#include "io/nominal_camera.h"

namespace tessera {
namespace {

constexpr std::string_view kMagic = "TESSERA1";
constexpr std::uint32_t kMostCameraBytes = 64 << 10;
constexpr const char* kExpected =
    "expected TESSERA1, the length and text of a camera.yaml, then frames (docs/camera.md)";

template <class Value>
Value ValueOf(const std::vector<std::uint8_t>& bytes, std::size_t offset = 0) {
    Value value;
    std::memcpy(&value, bytes.data() + offset, sizeof(value));
    return value;
}

class PipeSource : public FrameSource {
  public:
    PipeSource(std::string name, ByteStream stream, FolderSourceConfig config)
        : name_(std::move(name)), stream_(std::move(stream)), config_(std::move(config)) {}

    const SourceInfo& info() const override { return info_; }

    ReadResult Read(Frame& frame) override {
        while (true) {
            if (part_ != Part::kFrame) {
                const ReadResult greeted = ReadGreeting();
                if (greeted.status != ReadStatus::kOk) return greeted;
                continue;
            }
            switch (stream_.Read(wanted_, bytes_)) {
                case ByteStream::Got::kWait: return {ReadStatus::kWait, {}};
                case ByteStream::Got::kEnd: return SenderGone("");
                case ByteStream::Got::kAll: break;
            }
            if (header_) return Decode(frame);
            header_ = ValueOf<KlgHeader>(bytes_);
            if (!header_->Fits(info_.camera))
                return SenderGone(fmt::format("a frame has {} bytes of depth and {} of colour",
                                              header_->depth_bytes, header_->colour_bytes));
            wanted_ = static_cast<std::size_t>(header_->depth_bytes) +
                      static_cast<std::size_t>(header_->colour_bytes);
        }
    }

    bool Seek(std::int64_t) override { return false; }

    // Waits for the first sender's camera.
    Status Begin(double longest_wait_s, const std::atomic<bool>* stop) {
        const Stopwatch watch;
        while (part_ != Part::kFrame) {
            const ReadResult read = ReadGreeting();
            if (read.status == ReadStatus::kEnd)
                return Status::Error(name_ + ": ended before a frame; " + kExpected);
            if (read.status != ReadStatus::kOk && !read.message.empty())
                return Status::Error(read.message);
            if (stop != nullptr && stop->load())
                return Status::Error(name_ + ": stopped before a sender came");
            if (watch.ElapsedMs() > 1000 * longest_wait_s)
                return Status::Error(
                    fmt::format("{}: nothing came for {} s; start what sends the "
                                "frames",
                                name_, longest_wait_s));
        }
        return Status::Ok();
    }

  private:
    enum class Part { kGreeting, kCamera, kFrame };

    // Reads one more part of what precedes the frames.
    ReadResult ReadGreeting() {
        switch (stream_.Read(wanted_, bytes_)) {
            case ByteStream::Got::kWait: return {ReadStatus::kWait, {}};
            case ByteStream::Got::kEnd: return SenderGone("");
            case ByteStream::Got::kAll: break;
        }
        if (part_ == Part::kGreeting) {
            const auto length = ValueOf<std::uint32_t>(bytes_, kMagic.size());
            if (std::memcmp(bytes_.data(), kMagic.data(), kMagic.size()) != 0 || length == 0 ||
                length > kMostCameraBytes)
                return SenderGone(std::string("is not a stream of frames; ") + kExpected);
            part_ = Part::kCamera;
            wanted_ = length;
            return {};
        }
        if (Status status = TakeCamera(); !status.ok()) return SenderGone(status.message());
        part_ = Part::kFrame;
        wanted_ = sizeof(KlgHeader);
        return {};
    }

    Status TakeCamera() {
        Result<CameraCalibration> camera =
            ParseCameraText(std::string(bytes_.begin(), bytes_.end()), "its camera");
        if (!camera.ok()) return camera.status();
        if (Status status = CheckOneSize(camera.value()); !status.ok()) return status;
        CameraCalibration& calibration = camera.value();
        if (!calibration.depth_scale_given) calibration.depth_scale = 1000;  // millimetres
        calibration = Configured(calibration, config_);
        const std::string text = CameraFileText(calibration);
        if (!camera_text_.empty())
            return text == camera_text_
                       ? Status::Ok()
                       : Status::Error("the sender has another camera than the first one");
        camera_text_ = text;
        decoder_ = std::make_unique<KlgFrameDecoder>(
            calibration, KlgFrameDecoder::Options{config_.rectify, config_.swap_red_blue});
        info_.name = name_;
        info_.kind = "stream of frames";
        info_.camera = calibration.pinhole;
        info_.one_camera = !calibration.colour;
        info_.fps = calibration.fps;
        info_.live = true;
        info_.depth_units_per_m = calibration.depth_scale;
        info_.rectified = decoder_->rectifies();
        info_.lens_corrected = decoder_->corrects_lens();
        return Status::Ok();
    }

    ReadResult Decode(Frame& frame) {
        const KlgHeader header = *header_;
        header_.reset();
        wanted_ = sizeof(KlgHeader);
        const std::int64_t index = next_++;
        if (Status status = decoder_->Decode(bytes_, header.depth_bytes, frame); !status.ok())
            return {ReadStatus::kSkip,
                    fmt::format("{}: frame {}: {}", name_, index, status.message())};
        frame.index = index;
        frame.stamp_s = frame.colour_stamp_s = static_cast<double>(header.stamp_us) * 1e-6;
        frame.T_world_camera.reset();
        return {};
    }

    // The sender has gone, or is left because of what it sent.
    ReadResult SenderGone(const std::string& why) {
        const bool cut_off = header_ || stream_.partly() || part_ == Part::kCamera;
        const bool said_nothing = part_ == Part::kGreeting && !cut_off && why.empty();
        const std::string what = !why.empty() ? why
                                 : cut_off    ? "the sender went within a frame"
                                              : "the sender has gone";
        header_.reset();
        part_ = Part::kGreeting;
        wanted_ = kMagic.size() + sizeof(std::uint32_t);
        const bool waits = stream_.WaitsForSender();
        if (waits && said_nothing) return {ReadStatus::kWait, {}};
        if (waits && decoder_)
            return {ReadStatus::kWait, name_ + ": " + what + ", waiting for the next"};
        // What was wrong is told once; then the source ends.
        const bool told = std::exchange(ended_, true) || (why.empty() && !cut_off);
        return told ? ReadResult{ReadStatus::kEnd, {}}
                    : ReadResult{ReadStatus::kSkip, name_ + ": " + what};
    }

    const std::string name_;
    ByteStream stream_;
    const FolderSourceConfig config_;
    SourceInfo info_;
    std::string camera_text_;  // of the first sender
    std::unique_ptr<KlgFrameDecoder> decoder_;
    Part part_ = Part::kGreeting;
    std::size_t wanted_ = kMagic.size() + sizeof(std::uint32_t);  // bytes to read next
    std::optional<KlgHeader> header_;                             // of the frame that is being read
    std::vector<std::uint8_t> bytes_;
    std::int64_t next_ = 0;
    bool ended_ = false;
};

}  // namespace

Result<std::unique_ptr<FrameSource>> OpenPipeSource(const std::string& name,
                                                    const FolderSourceConfig& config,
                                                    double longest_wait_s,
                                                    const std::atomic<bool>* stop) {
    constexpr std::size_t kScheme = std::string_view(kPipePrefix).size();
    Result<ByteStream> stream = ByteStream::Open(name.substr(kScheme));
    if (!stream.ok()) return stream.status();
    return OpenPipeSource(name, std::move(stream.value()), config, longest_wait_s, stop);
}

Result<std::unique_ptr<FrameSource>> OpenPipeSource(const std::string& name, ByteStream stream,
                                                    const FolderSourceConfig& config,
                                                    double longest_wait_s,
                                                    const std::atomic<bool>* stop) {
    if (Status status = config.Validate(); !status.ok()) return status;
    auto source = std::make_unique<PipeSource>(name, std::move(stream), config);
    if (Status status = source->Begin(longest_wait_s, stop); !status.ok()) return status;
    return std::unique_ptr<FrameSource>(std::move(source));
}

}  // namespace tessera
