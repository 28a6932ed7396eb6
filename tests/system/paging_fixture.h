// A walk along a hall that is larger than the map may be, with two posters on its wall.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <memory>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "support/box_room_source.h"
#include "support/temp_folder.h"
#include "system/engine_fixture.h"
#include "system/run_control.h"

namespace tessera::paging_test {

using testing_support::BoxRoom;
using testing_support::BoxRoomSource;

inline constexpr int kSteps = 45, kTurn = 8, kFrames = 2 * kSteps + kTurn;

// Along a hall of 21 m, a turn at the end, and back. `aside_rad` turns the camera towards the wall
// of largest x.
inline Eigen::Isometry3d WalkPose(int i, double aside_rad = 0) {
    const int forth = std::min(i, kSteps), back = std::max(0, i - kSteps - kTurn);
    const double turned = std::numbers::pi * std::clamp(i - kSteps, 0, kTurn) / kTurn;
    Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
    T_world_camera.translation().z() = 0.4 * (forth - back);
    const double angle_rad = turned + aside_rad * (1 - 2 * turned / std::numbers::pi);
    T_world_camera.linear() =
        Eigen::AngleAxisd(angle_rad, Eigen::Vector3d::UnitY()).toRotationMatrix();
    return T_world_camera;
}

inline BoxRoom Hall() {
    BoxRoom room;
    room.low = {-1.0, -0.8, -1.0};
    room.high = {0.9, 0.7, 20.0};
    return room;
}

// Detects a poster at two places on the right wall.
class PosterDetector : public Detector {
  public:
    Result<std::vector<Detection>> Detect(const Frame& frame) override {
        std::vector<Detection> found;
        for (const double z_m : {3.4, 12.4}) {
            Detection poster;
            poster.name = "poster";
            poster.probability = 0.9f;
            if (Frames(frame, z_m, poster)) found.push_back(std::move(poster));
        }
        return found;
    }
    const std::vector<std::string>& class_names() const override { return names_; }

  private:
    // Sets the box and mask of the poster. Returns false if it is out of view or too small. The map
    // ends nearer than the 8 m limit used here.
    static bool Frames(const Frame& frame, double z_m, Detection& poster) {
        const PinholeCamera camera = testing_support::SmallCamera();
        Image<std::uint8_t> mask(camera.width, camera.height, 0);
        Eigen::AlignedBox2i box;
        for (int v = 0; v < camera.height; ++v)
            for (int u = 0; u < camera.width; ++u) {
                const double depth_m = frame.depth_m(u, v);
                const Eigen::Vector3d p = *frame.T_world_camera * camera.Unproject(u, v, depth_m);
                if (depth_m > 8 || p.x() < 0.88 || std::abs(p.y()) > 0.4 ||
                    std::abs(p.z() - z_m) > 0.6)
                    continue;
                mask(u, v) = 1;
                box.extend(Eigen::Vector2i(u, v));
            }
        if (box.isEmpty() || box.sizes().minCoeff() < 8) return false;
        poster.box = {static_cast<float>(box.min().x()), static_cast<float>(box.min().y()),
                      static_cast<float>(box.max().x()), static_cast<float>(box.max().y())};
        const PixelBox pixels = PixelsOf(poster.box, camera.width, camera.height);
        poster.mask.Resize(pixels.width(), pixels.height());
        for (int y = 0; y < pixels.height(); ++y)
            for (int x = 0; x < pixels.width(); ++x)
                poster.mask(x, y) = mask(x + pixels.x_begin, y + pixels.y_begin);
        return true;
    }

    std::vector<std::string> names_{"poster"};
};

class HallSource : public FrameSource {
  public:
    // `mapped`, if not null, counts the frames that have left the engine. The source stays at most
    // one frame ahead of it.
    HallSource(const std::atomic<int>* mapped, double aside_rad)
        : mapped_(mapped), aside_rad_(aside_rad) {
        info_ = BoxRoomSource({.count = kFrames}).info();
    }
    const SourceInfo& info() const override { return info_; }
    ReadResult Read(Frame& frame) override {
        if (next_ == kFrames) return {ReadStatus::kEnd, {}};
        if (mapped_ != nullptr && next_ > *mapped_) {
            RunControl::SleepBriefly();
            return {ReadStatus::kWait, {}};
        }
        frame = room_.Render(info_.camera, WalkPose(next_, aside_rad_), next_ / 30.0);
        frame.index = next_++;
        return {};
    }
    bool Seek(std::int64_t index) override {
        next_ = static_cast<int>(index);
        return true;
    }

  private:
    SourceInfo info_;
    BoxRoom room_ = Hall();
    int next_ = 0;
    const std::atomic<int>* mapped_;
    double aside_rad_;
};

class Paging : public EngineTest {
  protected:
    Paging() {
        config.pipeline.frame.max_depth_m = 2.0;
        config.scan.interval_s = 0.1;
    }

    void Start(bool live, double limit_mb, bool paced = false) {
        config.pipeline.memory_limit_mb = limit_mb;
        EngineInput input = Input({});
        input.source = std::make_unique<HallSource>(paced ? &mapped : nullptr, aside_rad);
        std::vector<StampedPose> poses;
        for (int i = 0; i < kFrames; ++i) poses.push_back({i / 30.0, WalkPose(i, aside_rad)});
        input.plan = FramePlan({}, std::move(poses), "poses");
        if (limit_mb > 0) {
            Result<ScanPlan> plan = BeginScan(path, BoxRoomSource().info(), config);
            EXPECT_TRUE(plan.ok()) << plan.message();
            input.scan = std::move(plan.value());
        }
        if (labels) {
            config.labels.classes = "poster";
            input.labelling.detector = std::make_unique<PosterDetector>();
            input.labelling.classes = LabelClasses::Make(config.labels, {"poster"}).value();
        }
        outcomes.clear();
        if (live)
            engine = std::make_unique<LiveEngine>(std::move(input));
        else
            engine = std::make_unique<LockstepEngine>(std::move(input));
    }
    TriangleMesh Run(bool live, double limit_mb) {
        mapped.store(0);
        Start(live, limit_mb, live);
        while (Next()) mapped.store(static_cast<int>(Count(Kind::kFrame)));
        EXPECT_TRUE(engine->status().ok()) << engine->status().message();
        resident = engine->map_statistics().blocks;
        TriangleMesh mesh = engine->TakeMesh();
        EXPECT_TRUE(engine->status().ok()) << engine->status().message();
        return mesh;
    }
    // Takes `count` more frames.
    void TakeFrames(int count) {
        for (std::int64_t end = Count(Kind::kFrame) + count; Count(Kind::kFrame) < end;)
            ASSERT_TRUE(Next());
    }
    std::int64_t MostBlocks() const {
        std::int64_t most = 0;
        for (const FrameOutcome& o : outcomes) most = std::max(most, o.map.blocks);
        return most;
    }

    static std::int64_t Labelled(const TriangleMesh& mesh) {
        return std::ranges::count_if(mesh.labels,
                                     [](const VertexLabel& label) { return label.instance != 0; });
    }

    TempFolder folder;
    std::string path = folder / "a.scan";
    bool labels = false;
    double aside_rad = 0;
    std::int64_t resident = 0;
    std::atomic<int> mapped{0};
};

}  // namespace tessera::paging_test
