#include "recordings/sens_index.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "recordings/recorded_stamps.h"

namespace tessera {
namespace {

constexpr std::uint32_t kSensVersion = 4;
constexpr std::uint64_t kMostSensNameBytes = 1 << 16;
constexpr std::uint64_t kMostSensImageBytes = std::uint64_t{256} << 20;
constexpr std::uint32_t kMostSensSide_px = 8192;
constexpr std::uint64_t kSensUncounted = std::numeric_limits<std::uint64_t>::max();
constexpr double kSensFps = 30;  // of files without time stamps

// Row-major, as stored.
using SensMatrix = Eigen::Matrix<float, 4, 4, Eigen::RowMajor>;

// What follows the sensor's name.
struct SensHeader {
    SensMatrix colour_intrinsic, colour_extrinsic, depth_intrinsic, depth_extrinsic;
    std::int32_t colour_kind, depth_kind;
    std::uint32_t colour_width, colour_height, depth_width, depth_height;
    float depth_shift;  // stored value of one metre
};

// What precedes a frame's images, after its pose.
struct SensFrameHeader {
    std::uint64_t colour_stamp_us, depth_stamp_us, colour_bytes, depth_bytes;
};
constexpr std::uint64_t kSensPoseBytes = 64;

// Reads one value after the other.
class SensCursor {
  public:
    SensCursor(const InputFile& file, std::uint64_t at) : file_(file), at_(at) {}

    std::uint64_t at() const { return at_; }
    std::uint64_t left() const { return at_ < file_.size() ? file_.size() - at_ : 0; }
    // False if the file ends before.
    template <class... Values>
    bool Read(Values&... values) {
        return (ReadOne(values) && ...);
    }
    bool Pass(std::uint64_t bytes) {
        if (bytes > left()) return false;
        at_ += bytes;
        return true;
    }

  private:
    template <class Value>
    bool ReadOne(Value& value) {
        std::uint8_t bytes[sizeof(Value)];
        const std::uint64_t from = at_;
        if (!Pass(sizeof(Value)) || !file_.ReadAt(from, bytes).ok()) return false;
        std::memcpy(static_cast<void*>(&value), bytes, sizeof(Value));
        return true;
    }

    const InputFile& file_;
    std::uint64_t at_;
};

bool ReadSensHeader(SensCursor& cursor, SensHeader& h) {
    return cursor.Read(h.colour_intrinsic, h.colour_extrinsic, h.depth_intrinsic, h.depth_extrinsic,
                       h.colour_kind, h.depth_kind, h.colour_width, h.colour_height, h.depth_width,
                       h.depth_height, h.depth_shift);
}

Status CheckSensHeader(const SensHeader& h) {
    const auto side = [](std::uint32_t px) { return px > 0 && px <= kMostSensSide_px; };
    const bool no_colour = h.colour_width == 0 && h.colour_height == 0;
    if (!side(h.depth_width) || !side(h.depth_height) ||
        (!no_colour && (!side(h.colour_width) || !side(h.colour_height))))
        return Status::Error(
            fmt::format("depth of {} x {} and colour of {} x {} pixels are not plausible; the "
                        "header is damaged",
                        h.depth_width, h.depth_height, h.colour_width, h.colour_height));
    if (!(h.depth_shift >= 1 && h.depth_shift <= 1e6f))
        return Status::Error(
            fmt::format("a depth shift of {} is not plausible; the header is "
                        "damaged",
                        h.depth_shift));
    if (h.depth_kind == static_cast<std::int32_t>(SensDepth::kOcci))
        return Status::Error("its depth has the occi compression; save it with zlib compression");
    if (h.depth_kind != 0 && h.depth_kind != 1)
        return Status::Error(fmt::format("its depth has the unknown compression {}", h.depth_kind));
    if (h.colour_kind < 0 || h.colour_kind > 2)
        return Status::Error(
            fmt::format("its colour has the unknown compression {}", h.colour_kind));
    return {};
}

CameraCalibration SensCamera(const SensMatrix& intrinsic, std::uint32_t width, std::uint32_t height,
                             float depth_shift) {
    CameraCalibration camera;
    camera.pinhole = {.width = static_cast<int>(width),
                      .height = static_cast<int>(height),
                      .fx = double{intrinsic(0, 0)},
                      .fy = double{intrinsic(1, 1)},
                      .cx = double{intrinsic(0, 2)},
                      .cy = double{intrinsic(1, 2)}};
    camera.depth_scale = double{depth_shift};
    camera.fps = kSensFps;
    return camera;
}

bool IsSensRigid(const Eigen::Matrix4d& m) {
    constexpr double kRounding = 1e-3, kMost_m = 10;
    return m.allFinite() && m.row(3).isApprox(Eigen::RowVector4d(0, 0, 0, 1), kRounding) &&
           (m.topLeftCorner<3, 3>() * m.topLeftCorner<3, 3>().transpose()).isIdentity(kRounding) &&
           m.topLeftCorner<3, 3>().determinant() > 0 &&
           m.topRightCorner<3, 1>().cwiseAbs().maxCoeff() < kMost_m;
}

// An extrinsic takes points of its camera to the colour camera's frame: ScanNet's converter
// (Converter/src/metaData.h) stores the inverse of "colorToDepthExtrinsics" for depth and the
// identity for colour, and its calibration multiplies points of depth with it.
Eigen::Isometry3d SensExtrinsic(const SensHeader& h, std::vector<std::string>& warnings) {
    const Eigen::Matrix4d colour = h.colour_extrinsic.cast<double>();
    const Eigen::Matrix4d depth = h.depth_extrinsic.cast<double>();
    if (!IsSensRigid(colour) || !IsSensRigid(depth)) {
        warnings.push_back(
            "the extrinsic matrices are no rigid transforms; depth and colour are taken to be "
            "registered");
        return Eigen::Isometry3d::Identity();
    }
    if (colour == depth) return Eigen::Isometry3d::Identity();
    return Eigen::Isometry3d(colour).inverse() * Eigen::Isometry3d(depth);
}

void WalkSensFrames(SensCursor& cursor, std::uint64_t count, SensIndex& index) {
    std::string why;
    while (index.frames.size() < count) {
        SensFrameHeader header;
        if (!cursor.Pass(kSensPoseBytes) || !cursor.Read(header)) break;
        const std::uint64_t most = std::max(header.colour_bytes, header.depth_bytes);
        if (most == 0 || most > kMostSensImageBytes) {
            why = fmt::format(" (frame {} has {} bytes of colour and {} of depth)",
                              index.frames.size(), header.colour_bytes, header.depth_bytes);
            break;
        }
        const SensFrame frame{cursor.at(), static_cast<std::uint32_t>(header.colour_bytes),
                              static_cast<std::uint32_t>(header.depth_bytes)};
        if (!cursor.Pass(header.colour_bytes + header.depth_bytes)) break;
        index.frames.push_back(frame);
        index.info.pairs.push_back({.depth_stamp_s = static_cast<double>(header.depth_stamp_us),
                                    .colour_stamp_s = static_cast<double>(header.colour_stamp_us)});
    }
    const std::size_t found = index.frames.size();
    if (count == kSensUncounted)
        index.info.warnings.push_back(
            fmt::format("the recording was not closed; {} frames were found", found));
    else if (found < count)
        index.info.warnings.push_back(
            fmt::format("the file is truncated or damaged{}: {} of its {} frames are present", why,
                        found, count));
}

// The pairs come with microseconds.
void SetSensStamps(RecordingInfo& info) {
    const auto zero = [](const RecordedPair& p) { return p.depth_stamp_s == 0; };
    const bool stamped = !std::ranges::all_of(info.pairs, zero);
    for (RecordedPair& pair : info.pairs) {
        pair.depth_stamp_s *= 1e-6;
        pair.colour_stamp_s *= 1e-6;
        constexpr double kMostApart_s = 1;
        if (!(std::abs(pair.colour_stamp_s - pair.depth_stamp_s) <= kMostApart_s))
            pair.colour_stamp_s = pair.depth_stamp_s;
    }
    info.fps = kSensFps;
    if (stamped && DepthStampsIncrease(info.pairs)) {
        info.fps = MedianFps(info.pairs, kSensFps);
        return;
    }
    (stamped ? info.warnings : info.notes)
        .push_back(fmt::format(
            "{}; {} frames per second are assumed",
            stamped ? "the time stamps do not increase" : "the file has no time stamps", kSensFps));
    info.pairs = EvenlyStamped(info.pairs.size(), kSensFps);
}

}  // namespace

Result<SensIndex> ReadSensIndex(const InputFile& file) {
    SensCursor cursor(file, 0);
    std::uint32_t version = 0;
    std::uint64_t name_bytes = 0, count = 0;
    SensHeader header;
    if (!cursor.Read(version, name_bytes) || name_bytes > kMostSensNameBytes)
        return Status::Error(file.path() + ": is no ScanNet recording (.sens)");
    if (version != kSensVersion)
        return Status::Error(
            fmt::format("{}: has version {} of the .sens format; version {} is read", file.path(),
                        version, kSensVersion));
    if (!cursor.Pass(name_bytes) || !ReadSensHeader(cursor, header) || !cursor.Read(count))
        return Status::Error(file.path() + ": ends within its header; copy it again");
    if (Status status = CheckSensHeader(header); !status.ok())
        return Status::Error(file.path() + ": " + status.message());
    SensIndex index;
    index.colour = static_cast<SensColour>(header.colour_kind);
    index.depth = static_cast<SensDepth>(header.depth_kind);
    index.has_colour = header.colour_width > 0;
    RecordingInfo& info = index.info;
    info.kind = "ScanNet recording";
    info.depth_camera = SensCamera(header.depth_intrinsic, header.depth_width, header.depth_height,
                                   header.depth_shift);
    info.colour_camera = info.depth_camera;
    info.has_colour = index.has_colour;
    if (index.has_colour) {
        info.colour_camera = SensCamera(header.colour_intrinsic, header.colour_width,
                                        header.colour_height, header.depth_shift);
        info.T_colour_depth = SensExtrinsic(header, info.warnings);
    }
    // A recording that was not closed has frames, but their number was never written.
    WalkSensFrames(cursor, count > 0 ? count : kSensUncounted, index);
    if (index.frames.empty())
        return Status::Error(file.path() + ": contains no complete frame; copy it again");
    SetSensStamps(info);
    return index;
}

}  // namespace tessera
