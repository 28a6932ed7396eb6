#include "io/openni_source.h"

#include <algorithm>
#include <array>
#include <chrono>

#include "core/input_file.h"
#include "io/camera_store.h"
#include "io/device_clock.h"
#include "io/openni_camera.h"
#include "io/rectifier.h"
#include "io/stream_pairing.h"
#include "io/stream_watch.h"

namespace tessera {
namespace {

constexpr double kLongestRead_s = 0.4;
// A recording that delivers nothing for this long has no end marker. At the recorded pace it may
// contain a pause.
constexpr double kLostEnd_s = 1.5, kLostEndRecordedPace_s = 5;
constexpr std::int64_t kManyAlone = 10;  // unpaired images before the user is told
// Largest step of a camera's stamps and of a recording's stamps.
constexpr double kLargestJump_s = 10, kLargestPause_s = 1e6;

double Now_s() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch())
        .count();
}

class OpenniSource : public FrameSource {
  public:
    OpenniSource(const std::string& name, bool is_recording, std::shared_ptr<OpenniRuntime> runtime,
                 std::unique_ptr<OpenniCamera> camera, const OpenniConfig& config)
        : config_(config),
          any_device_(name == kOpenniPrefix),
          is_recording_(is_recording),
          runtime_(std::move(runtime)),
          camera_(std::move(camera)),
          about_(camera_->about()),
          rectifier_(about_.calibration, {}),
          pairing_(config.max_pair_gap_s, about_.shortest_period_s),
          clock_(is_recording ? kLargestPause_s : kLargestJump_s),
          read_s_(Now_s()),
          watch_(read_s_),
          prefix_(any_device_ ? "" : name + ": ") {
        info_.name = name;
        info_.kind = is_recording ? ".oni recording" : about_.name + " (OpenNI2 camera)";
        info_.camera = about_.calibration.pinhole;
        info_.camera_known = about_.camera_known;
        info_.camera_from = about_.camera_from;
        info_.one_camera = !about_.calibration.colour;
        info_.rectified = rectifier_.active();
        info_.lens_corrected = rectifier_.corrects_lens();
        info_.calibration_file = CalibrationPath(about_.serial);
        info_.frame_count = about_.frame_count;
        info_.fps = about_.fps;
        info_.live = !is_recording || config.playback == OpenniConfig::Playback::kRecorded;
        info_.depth_units_per_m = about_.calibration.depth_scale;
        info_.notes = about_.notes;
    }

    const SourceInfo& info() const override { return info_; }
    bool Seek(std::int64_t) override { return false; }

    Status RecordTo(const std::string& path, bool lossless_colour) override {
        if (is_recording_) return FrameSource::RecordTo(path, lossless_colour);
        if (!camera_) return Status::Error(path + ": the camera is unplugged");
        const Status status = camera_->Record(path, lossless_colour);
        if (status.ok()) recording_path_ = path;
        return status;
    }

    ReadResult Read(Frame& frame) override {
        watch_.NotHeard(Now_s() - read_s_);
        ReadResult result = ReadNext(frame);
        read_s_ = Now_s();
        return result;
    }

  private:
    ReadResult ReadNext(Frame& frame) {
        if (drained_) return {ReadStatus::kEnd, {}};
        if (!camera_) return Reconnect();
        for (const double deadline_s = Now_s() + kLongestRead_s;;) {
            if (TakePair(frame)) return {};
            if (ended_) return EndOfRecording();
            if (camera_->WasUnplugged()) return Unplug();
            const OpenniCamera::Arrival arrival =
                camera_->Wait(deadline_s - Now_s(), depth_, colour_);
            const double now_s = Now_s();
            if (arrival.event == OpenniCamera::Event::kEnd) {
                ended_ = true;
                pairing_.End();
            } else if (arrival.event != OpenniCamera::Event::kNothing) {
                if (ReadResult result = Take(arrival, now_s); result.status != ReadStatus::kOk)
                    return result;
            }
            if (std::string trouble = Trouble(now_s); !trouble.empty())
                return {ReadStatus::kWait, std::move(trouble)};
            if (now_s >= deadline_s && !ended_) return {ReadStatus::kWait, {}};
        }
    }

    bool TakePair(Frame& frame) {
        if (!pairing_.Next(pair_)) return false;
        frame.index = next_index_++;
        frame.stamp_s = pair_.depth_stamp_s;
        frame.colour_stamp_s = pair_.colour_stamp_s;
        frame.T_world_camera.reset();
        rectifier_.Fill(pair_.depth, pair_.colour, frame);
        return true;
    }

    // Checks the image and passes it to the pairing. Returns kSkip if it is unusable.
    ReadResult Take(const OpenniCamera::Arrival& arrival, double now_s) {
        const bool is_depth = arrival.event == OpenniCamera::Event::kDepth;
        watch_.Heard(is_depth, now_s);
        const auto skip = [&](const std::string& why) {
            return ReadResult{ReadStatus::kSkip,
                              fmt::format("{}{} image {}: {}", prefix_,
                                          is_depth ? "depth" : "colour", arrival.number, why)};
        };
        if (!arrival.fault.empty()) return skip(arrival.fault);
        const DeviceClock::Reading reading = clock_.Read(is_depth ? 0 : 1, arrival.stamp_us, now_s);
        if (reading.verdict == DeviceClock::Verdict::kBackwards)
            return skip("its time stamp is not later than the previous one");
        if (reading.verdict == DeviceClock::Verdict::kAbsurd)
            return skip(fmt::format("its time stamp of {} us is implausible", arrival.stamp_us));
        if (reading.was_reset) {
            pairing_.Clear();
            message_ =
                prefix_ + "the camera's clock jumped; time stamps continue from the last one";
        }
        if (is_depth)
            pairing_.AddDepth(reading.stamp_s, depth_);
        else
            pairing_.AddColour(reading.stamp_s, colour_);
        return {};
    }

    // Returns what the user should know now, each thing once. Usually empty.
    std::string Trouble(double now_s) {
        if (!message_.empty()) return std::exchange(message_, {});
        if (is_recording_ &&
            watch_.Silence_s(now_s) > (info_.live ? kLostEndRecordedPace_s : kLostEnd_s)) {
            ended_ = true;
            pairing_.End();
            return prefix_ + "the recording is truncated; all frames in it were read";
        }
        const std::string silence = is_recording_ ? "" : watch_.NewSilence(now_s);
        if (!silence.empty()) return WithoutFrameSync(prefix_ + silence);
        const std::int64_t alone = pairing_.depth_alone();
        if (alone < kManyAlone || alone_told_) return {};
        alone_told_ = true;
        return fmt::format(
            "{}{} of the first {} depth images had no colour image within {:.0f} ms and were "
            "dropped (do depth and colour have different frame rates?)",
            prefix_, alone, alone + pairing_.pairs(), 1000 * config_.max_pair_gap_s);
    }

    std::string WithoutFrameSync(const std::string& silence) {
        if (!camera_->about().frame_sync) return silence;
        camera_->StopFrameSync();
        return silence + "; trying without frame sync";
    }

    ReadResult EndOfRecording() {
        drained_ = true;
        const std::int64_t alone = pairing_.depth_alone();
        if (alone == 0) return {ReadStatus::kEnd, {}};
        return {ReadStatus::kWait,
                fmt::format(
                    "{}{} of {} depth images had no colour image within {:.0f} ms and were dropped",
                    prefix_, alone, alone + pairing_.pairs(), 1000 * config_.max_pair_gap_s)};
    }

    ReadResult Unplug() {
        camera_.reset();
        pairing_.Clear();
        // The library cannot reliably start a second recording: see openni_runtime.h.
        const std::string recording =
            recording_path_.empty() ? "" : "; the recording " + recording_path_ + " ends here";
        recording_path_.clear();
        return {ReadStatus::kWait, prefix_ + "camera unplugged, waiting for it" + recording};
    }

    // Tries once, for at most a fraction of a second.
    ReadResult Reconnect() {
        constexpr double kBetweenTries_s = 0.2;
        for (const OpenniDevice& device : runtime_->Devices()) {
            if (!any_device_ && !IsSameOpenniKind(device.uri, about_.uri)) continue;
            Result<std::unique_ptr<OpenniCamera>> opened =
                OpenniCamera::Open(runtime_, device.uri, false, config_);
            if (!opened.ok()) continue;  // still starting, or in use
            const OpenniCamera::About& about = opened.value()->about();
            if (about.camera != about_.camera ||
                about.depth_units_per_m != about_.depth_units_per_m)
                continue;
            camera_ = std::move(opened.value());
            about_.uri = about.uri;
            clock_.Restart();
            watch_ = StreamWatch(Now_s());
            return {ReadStatus::kWait, prefix_ + "camera is back"};
        }
        runtime_->WaitForChange(kBetweenTries_s);
        return {ReadStatus::kWait, {}};
    }

    const OpenniConfig config_;
    const bool any_device_, is_recording_;
    std::shared_ptr<OpenniRuntime> runtime_;
    std::unique_ptr<OpenniCamera> camera_;  // null while unplugged
    OpenniCamera::About about_;             // of the current or last camera
    Rectifier rectifier_;
    SourceInfo info_;
    StreamPairing pairing_;
    DeviceClock clock_;
    StreamPairing::Pair pair_;
    Image<std::uint16_t> depth_;
    ColourImage colour_;
    double read_s_;  // when Read returned last
    StreamWatch watch_;
    std::int64_t next_index_ = 0;
    bool ended_ = false, drained_ = false;  // no more images; no more pairs
    bool alone_told_ = false;
    const std::string prefix_;  // for messages
    std::string message_;
    std::string recording_path_;  // empty: the camera is not recording
};

// Checks that the file starts like an .oni file.
Status CheckRecording(const std::string& path) {
    const Result<InputFile> file = InputFile::Open(path);
    if (!file.ok()) return file.status();
    std::array<std::uint8_t, 4> magic{};
    if (file.value().size() < magic.size() || !file.value().ReadAt(0, magic).ok() ||
        std::string(magic.begin(), magic.end()) != "NI10")
        return Status::Error(path + ": is not an .oni recording (it does not start with NI10)");
    return Status::Ok();
}

}  // namespace

Result<std::unique_ptr<FrameSource>> OpenOpenniSource(const std::string& name,
                                                      const OpenniConfig& config) {
    const bool is_recording = !name.starts_with(kOpenniPrefix);
    if (is_recording)
        if (Status status = CheckRecording(name); !status.ok()) return status;
    Result<std::shared_ptr<OpenniRuntime>> runtime = OpenniRuntime::Acquire();
    if (!runtime.ok()) return Status::Error(name + ": " + runtime.message());
    const Result<std::string> uri =
        is_recording ? name : FindOpenniDevice(name, runtime.value()->Devices());
    if (!uri.ok()) return uri.status();
    Result<std::unique_ptr<OpenniCamera>> camera =
        OpenniCamera::Open(runtime.value(), uri.value(), is_recording, config);
    if (!camera.ok()) return Status::Error(name + ": " + camera.message());
    return std::unique_ptr<FrameSource>(std::make_unique<OpenniSource>(
        name, is_recording, runtime.value(), std::move(camera.value()), config));
}

}  // namespace tessera
