#include "recordings/ros_message.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace tessera {
namespace {

// Reads values one after the other. After the first that is not there, all are zero and ok() is
// false.
class RosCursor {
  public:
    RosCursor(RosSerialisation serialisation, ByteView bytes)
        : cdr_(serialisation == RosSerialisation::kCdr), bytes_(bytes) {
        if (!cdr_) return;
        // CDR begins with two bytes of kind, of which only little endian is read, and two unused.
        constexpr std::size_t kHead = 4;
        ok_ = bytes.size() >= kHead && bytes[0] == 0 && bytes[1] == 1;
        bytes_ = ok_ ? bytes.subspan(kHead) : ByteView();
    }

    template <class T>
    T Get() {
        if (cdr_) at_ = (at_ + sizeof(T) - 1) / sizeof(T) * sizeof(T);
        T value{};
        const ByteView raw = Take(sizeof(T));
        if (!raw.empty()) std::memcpy(&value, raw.data(), sizeof(T));
        return value;
    }
    ByteView Bytes() { return Take(Get<std::uint32_t>()); }
    std::string_view Text() {
        const ByteView raw = Bytes();
        std::string_view text(reinterpret_cast<const char*>(raw.data()), raw.size());
        if (cdr_ && text.ends_with('\0')) text.remove_suffix(1);
        return text;
    }
    // Fails if there cannot be so many.
    std::uint32_t Count(std::size_t least_bytes) {
        const auto count = Get<std::uint32_t>();
        ok_ = ok_ && at_ <= bytes_.size() && count <= (bytes_.size() - at_) / least_bytes;
        return ok_ ? count : 0;
    }
    RosHeader Header() {
        if (!cdr_) Get<std::uint32_t>();  // the sequence number
        RosHeader header;
        header.stamp_s = Get<std::uint32_t>();
        header.stamp_s += 1e-9 * Get<std::uint32_t>();
        header.frame_id = Text();
        return header;
    }
    // nullopt if the numbers are no transform.
    std::optional<Eigen::Isometry3d> Transform() {
        double values[7];
        for (double& value : values) value = Get<double>();
        Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
        const Eigen::Quaterniond q(values[6], values[3], values[4], values[5]);
        const bool rotation = std::abs(q.norm() - 1) < 1e-3;
        const Eigen::Vector3d t(values[0], values[1], values[2]);
        if (!ok_ || !rotation || !t.allFinite()) return std::nullopt;
        T.linear() = q.normalized().toRotationMatrix();
        T.translation() = t;
        return T;
    }
    std::size_t left() const { return bytes_.size() - std::min(at_, bytes_.size()); }
    bool ok() const { return ok_; }

  private:
    ByteView Take(std::size_t size) {
        ok_ = ok_ && at_ <= bytes_.size() && size <= bytes_.size() - at_;
        if (!ok_) return {};
        at_ += size;
        return bytes_.subspan(at_ - size, size);
    }

    bool cdr_, ok_ = true;
    ByteView bytes_;
    std::size_t at_ = 0;
};

template <class Message>
std::optional<Message> IfOk(const RosCursor& cursor, Message message) {
    if (!cursor.ok()) return std::nullopt;
    return message;
}

}  // namespace

std::optional<RosHeader> ParseHeader(RosSerialisation serialisation, ByteView bytes) {
    RosCursor cursor(serialisation, bytes);
    return IfOk(cursor, cursor.Header());
}

std::optional<RosImage> ParseImage(RosSerialisation serialisation, ByteView bytes) {
    RosCursor cursor(serialisation, bytes);
    RosImage image;
    image.header = cursor.Header();
    image.height = cursor.Get<std::uint32_t>();
    image.width = cursor.Get<std::uint32_t>();
    image.encoding = cursor.Text();
    image.big_endian = cursor.Get<std::uint8_t>() != 0;
    image.row_bytes = cursor.Get<std::uint32_t>();
    image.data = cursor.Bytes();
    if (serialisation == RosSerialisation::kRos1 && image.header.frame_id == kRealsenseFrame &&
        cursor.left() == sizeof(float))
        image.depth_unit_m = cursor.Get<float>();
    const bool whole =
        image.data.size() >= std::uint64_t{image.row_bytes} * image.height && image.width > 0;
    return whole ? IfOk(cursor, image) : std::nullopt;
}

std::optional<RosCompressedImage> ParseCompressedImage(RosSerialisation serialisation,
                                                       ByteView bytes) {
    RosCursor cursor(serialisation, bytes);
    RosCompressedImage image;
    image.header = cursor.Header();
    image.format = cursor.Text();
    image.data = cursor.Bytes();
    return IfOk(cursor, image);
}

std::optional<RosCameraInfo> ParseCameraInfo(RosSerialisation serialisation, ByteView bytes) {
    RosCursor cursor(serialisation, bytes);
    RosCameraInfo info;
    info.header = cursor.Header();
    info.height = cursor.Get<std::uint32_t>();
    info.width = cursor.Get<std::uint32_t>();
    info.distortion_model = cursor.Text();
    info.distortion.resize(cursor.Count(sizeof(double)));
    for (double& value : info.distortion) value = cursor.Get<double>();
    for (double& value : info.k) value = cursor.Get<double>();
    for (int i = 0; i < 9; ++i) cursor.Get<double>();  // the rotation of a stereo pair
    for (double& value : info.p) value = cursor.Get<double>();
    return IfOk(cursor, info);
}

std::vector<RosTransform> ParseTransforms(RosSerialisation serialisation, ByteView bytes) {
    constexpr std::size_t kLeastBytes = 64;  // of a transform
    RosCursor cursor(serialisation, bytes);
    std::vector<RosTransform> transforms;
    for (std::uint32_t left = cursor.Count(kLeastBytes); left > 0; --left) {
        RosTransform transform;
        transform.header = cursor.Header();
        transform.child_frame_id = cursor.Text();
        const auto T_frame_child = cursor.Transform();
        if (!T_frame_child) continue;
        transform.T_frame_child = *T_frame_child;
        transforms.push_back(transform);
    }
    if (!cursor.ok()) transforms.clear();
    return transforms;
}

std::optional<Eigen::Isometry3d> ParseTransform(RosSerialisation serialisation, ByteView bytes) {
    RosCursor cursor(serialisation, bytes);
    return cursor.Transform();
}

}  // namespace tessera
