// A scan file with raw frames of the box room at exactly known poses, and points on the room's
// surface.
#pragma once

#include "io/image_io.h"
#include "scan/small_scan.h"
#include "support/box_room.h"

namespace tessera::testing_support {

inline constexpr int kPosedFrames = 5, kLostFrame = 2;

inline BoxRoom PosedRoom() {
    BoxRoom room;
    room.has_ball = true;
    room.texture = 0.6;  // avoids clipped colours
    return room;
}

inline Eigen::Isometry3d PosedCamera(int frame) { return SmoothPath(20 * frame); }

// A colour whose channels differ.
inline Rgb8 Warm(std::uint8_t grey) {
    return {grey, static_cast<std::uint8_t>(grey * 7 / 10),
            static_cast<std::uint8_t>(grey * 4 / 10)};
}

// Frame kLostFrame has no pose. Depth is stored in steps of 0.2 mm.
inline void WritePosedScan(const std::string& path, bool with_frames = true) {
    ScanMeta meta = SmallMeta();
    meta.camera = SmallCamera();
    Result<std::unique_ptr<ScanFile>> file = ScanFile::Create(path, meta.Encode());
    ASSERT_TRUE(file.ok()) << file.message();
    ScanWriter writer(std::move(file.value()), meta.depth_units_per_m);
    ScanCheckpoint checkpoint;
    for (int i = 0; i < kPosedFrames; ++i) {
        PathRecord record;
        record.index = i;
        record.stamp_s = 20 * i / 30.0;
        record.status = i == kLostFrame ? TrackStatus::kLost : TrackStatus::kGood;
        record.T_reference_camera = PosedCamera(i);
        checkpoint.path.emplace_back(i, record);
        if (!with_frames) continue;
        auto frame = std::make_unique<Frame>(
            PosedRoom().Render(SmallCamera(), PosedCamera(i), record.stamp_s));
        for (std::size_t k = 0; k < frame->colour.size(); ++k)
            frame->colour.data()[k] = Warm(frame->colour.data()[k].r);
        checkpoint.raw_frames.emplace_back(i, std::move(frame));
    }
    checkpoint.progress = {kPosedFrames, 0, 0, kPosedFrames - 1, 20 * (kPosedFrames - 1) / 30.0,
                           false};
    checkpoint.finished = true;
    ASSERT_TRUE(writer.Write(checkpoint).ok());
    writer.Close();
}

// The surface point seen at the centre of a pixel, in the world frame.
inline Eigen::Vector3d SeenAt(int frame, int u, int v) {
    const Eigen::Vector3d ray = PosedCamera(frame).linear() * SmallCamera().Unproject(u, v, 1.0);
    const Eigen::Vector3d origin = PosedCamera(frame).translation();
    return origin + PosedRoom().Cast(origin, ray) * ray;
}

inline Rgb8 ColourAt(const Eigen::Vector3d& p_world) {
    return Warm(static_cast<std::uint8_t>(255.0 * PosedRoom().Intensity(p_world) + 0.5));
}

// `count` surface points with their colours.
inline TriangleMesh PointsOfTheRoom(int count) {
    TriangleMesh mesh;
    for (int i = 0; i < count; ++i) {
        const Eigen::Vector3d p = SeenAt(0, i % 160, i / 160 % 120);
        mesh.vertices.push_back(p.cast<float>());
        mesh.colours.push_back(ColourAt(p));
    }
    return mesh;
}

// Compares pixels of two images of the same smooth pattern. One image is a JPEG.
inline void ExpectSimilar(const Rgb8& a, const Rgb8& b, int u, int v) {
    for (const int difference : {a.r - b.r, a.g - b.g, a.b - b.b})
        ASSERT_LE(std::abs(difference), 12) << u << ", " << v;
}

}  // namespace tessera::testing_support
