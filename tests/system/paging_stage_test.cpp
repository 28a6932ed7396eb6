// Maps that exceed their memory limit, in a long box room.
#include "system/paging_stage.h"

#include <cstdio>
#include <filesystem>
#include <numbers>

#include "run/scan_export.h"
#include "support/temp_folder.h"
#include "system/engine_fixture.h"
#include "system/run_control.h"

namespace tessera {
namespace {

using testing_support::BoxRoom;
using testing_support::BoxRoomSource;

constexpr int kSteps = 45, kTurn = 8, kFrames = 2 * kSteps + kTurn;

// Along a hall of 21 m, a turn at the end, and back. `aside_rad` turns the camera towards the wall
// of largest x.
Eigen::Isometry3d WalkPose(int i, double aside_rad = 0) {
    const int forth = std::min(i, kSteps), back = std::max(0, i - kSteps - kTurn);
    const double turned = std::numbers::pi * std::clamp(i - kSteps, 0, kTurn) / kTurn;
    Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
    T_world_camera.translation().z() = 0.4 * (forth - back);
    const double angle_rad = turned + aside_rad * (1 - 2 * turned / std::numbers::pi);
    T_world_camera.linear() =
        Eigen::AngleAxisd(angle_rad, Eigen::Vector3d::UnitY()).toRotationMatrix();
    return T_world_camera;
}

BoxRoom Hall() {
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
        config.pipeline.paging.memory_limit_mb = limit_mb;
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

TEST_F(Paging, ALimitChangesNothingButTheMemory) {
    const TriangleMesh whole = Run(false, 0);
    const std::int64_t blocks = resident;
    const auto expected = std::move(outcomes);
    constexpr double kLimit_mb = 24;
    const TriangleMesh mesh = Run(false, kLimit_mb);
    ASSERT_GT(whole.triangles.size(), 100000u);
    EXPECT_EQ(mesh.vertices, whole.vertices);
    EXPECT_EQ(mesh.normals, whole.normals);
    EXPECT_EQ(mesh.colours, whole.colours);
    EXPECT_EQ(mesh.triangles, whole.triangles);
    EXPECT_LT(2 * MostBlocks(), blocks);
    for (const FrameOutcome& o : outcomes)
        EXPECT_LT(static_cast<double>(o.map.bytes), 1e6 * kLimit_mb);
    EXPECT_EQ(Messages().find("memory_limit"), std::string::npos);
    EXPECT_FALSE(std::filesystem::exists(path + "-wal")) << "the journal is merged into the file";

    {
        const Result<ScanContent> scan = ReadScan(path, {});
        ASSERT_TRUE(scan.ok()) << scan.message();
        EXPECT_EQ(scan.value().map->count(), blocks) << "the file holds the whole map";
    }
    // The paging of blocks depends only on the frames.
    ASSERT_EQ(std::remove(path.c_str()), 0);
    const auto first = std::move(outcomes);
    Run(false, kLimit_mb);
    ASSERT_EQ(outcomes.size(), first.size());
    for (std::size_t i = 0; i < first.size(); ++i)
        EXPECT_EQ(outcomes[i].map.blocks, first[i].map.blocks) << i;
}

TEST_F(Paging, LabelsAndObjectsAreTheSameWithALimit) {
    labels = true;
    aside_rad = 0.6;
    config.labels.min_observations = 4;
    const TriangleMesh whole = Run(false, 0);
    const std::string objects = ObjectsJson(engine->objects());
    ASSERT_EQ(engine->objects().size(), 2u) << objects;
    ASSERT_GT(Labelled(whole), 1000);
    const std::int64_t blocks = resident;
    const TriangleMesh mesh = Run(false, 28);
    EXPECT_LT(2 * MostBlocks(), blocks);
    EXPECT_EQ(mesh.vertices, whole.vertices);
    EXPECT_EQ(mesh.triangles, whole.triangles);
    EXPECT_TRUE(mesh.labels == whole.labels);
    EXPECT_EQ(ObjectsJson(engine->objects()), objects);
    Result<ScanContent> scan = ReadScan(path, {});
    ASSERT_TRUE(scan.ok()) << scan.message();
    const Result<TriangleMesh> exported = MeshOfScan(scan.value());
    ASSERT_TRUE(exported.ok()) << exported.message();
    EXPECT_TRUE(exported.value().labels == whole.labels);
}

// The first poster must not shrink in the window after it has been paged out.
TEST_F(Paging, ObjectsInTheWindowDoNotShrinkWhileTheyAreAway) {
    labels = true;
    aside_rad = 0.6;
    config.labels.min_observations = 4;
    config.live.mesh_blocks = 100000;
    ViewerLink link;
    viewer = &link;
    std::vector<MapObject> before, last;
    Start(false, 28);
    for (int i = 0; i < kSteps; ++i) {
        TakeFrames(1);
        MeshUpdate mesh;
        while (link.meshes.TryPop(mesh)) {
        }
        while (link.objects.TryPop(last)) {
            if (last.size() == 1) before = last;
        }
    }
    ASSERT_EQ(before.size(), 1u);
    ASSERT_EQ(last.size(), 2u);
    const auto poster = std::ranges::find(last, before[0].id, &MapObject::id);
    ASSERT_NE(poster, last.end());
    EXPECT_GT(poster->vertices, 500);
    EXPECT_GE(poster->vertices, 0.95 * static_cast<double>(before[0].vertices));
    EXPECT_LT((poster->box.min() - before[0].box.min()).norm(), 0.03);
    EXPECT_LT((poster->box.max() - before[0].box.max()).norm(), 0.03);
}

// Some frames are not fused because their blocks are paged out. No block may be duplicated or lost.
TEST_F(Paging, LiveKeepsTheLimitAndTheMap) {
    const TriangleMesh mesh = Run(true, 24);
    const Result<ScanContent> scan = ReadScan(path, {});
    ASSERT_TRUE(scan.ok()) << scan.message();
    const std::int64_t stored = scan.value().map->count();
    EXPECT_GE(stored, resident);
    ASSERT_GT(mesh.triangles.size(), 100000u);
    const BoxRoom hall = Hall();
    for (const Eigen::Vector3f& v : mesh.vertices)
        ASSERT_LT(std::abs(hall.SignedDistance(v.cast<double>())), 0.02) << v.transpose();
    if (2 * stored <= 3 * resident)
        GTEST_SKIP() << "the machine is too slow: blocks were not saved in time to be paged out";
}

TEST_F(Paging, ALimitThatIsTooSmallIsSaidOnce) {
    Run(false, 1);
    const std::string said = Messages();
    const std::size_t at = said.find("mapping.memory_limit_mb: 1 MB is not enough");
    ASSERT_NE(at, std::string::npos) << said;
    EXPECT_EQ(said.find("memory_limit_mb", at + 20), std::string::npos);
}

// The blocks between 2 and 4 m of the hall are damaged while they are paged out.
TEST_F(Paging, WhatCannotBeReadBackIsSaidOnceAndNothingIsFusedThere) {
    Start(false, 24);
    TakeFrames(kSteps + kTurn);
    {
        auto reader = CubeReader::Open(path);
        ASSERT_TRUE(reader.ok());
        auto database = Database::Open(path, Database::Access::kWrite);
        ASSERT_TRUE(database.ok());
        const double cube_m = kCubeBlocks * kBlockSide * config.pipeline.map.voxel_size_m;
        const auto cubes = reader.value()->Cubes();
        ASSERT_TRUE(cubes.ok());
        for (const auto& [key, blocks] : cubes.value()) {
            const double z_m = CubeOfKey(key).z * cube_m;
            if (z_m < 2 || z_m > 4) continue;
            const std::string keys =
                std::to_string(key) + " AND " + std::to_string(key + kCubeKeys - 1);
            ASSERT_TRUE(
                database.value()
                    ->Execute("UPDATE blocks SET checksum = checksum + 1 WHERE key BETWEEN " + keys)
                    .ok());
        }
    }
    TakeAll();
    EXPECT_TRUE(engine->status().ok()) << engine->status().message();
    const std::string said = Messages();
    const std::size_t at = said.find("tessera scan repair");
    ASSERT_NE(at, std::string::npos) << said;
    EXPECT_NE(said.find("not fused"), std::string::npos);
    EXPECT_EQ(said.find("tessera scan repair", at + 1), std::string::npos);
    int not_fused = 0;
    for (const FrameOutcome& o : outcomes) {
        if (o.kind != Kind::kFrame) continue;
        const double z_m = WalkPose(static_cast<int>(o.report.index)).translation().z();
        const bool back = o.report.index >= kSteps + kTurn;
        not_fused += !o.report.fused;
        EXPECT_EQ(o.report.fused, !o.fusion_dropped);
        const bool far = !back || z_m > 8, within = back && z_m > 3 && z_m < 5;
        EXPECT_TRUE(o.report.fused || !far) << o.report.index;
        EXPECT_FALSE(o.report.fused && within) << o.report.index;
    }
    EXPECT_GT(not_fused, 5);
    EXPECT_TRUE(engine->TakeMesh().triangles.empty());
    EXPECT_NE(engine->status().message().find("tessera scan repair"), std::string::npos)
        << engine->status().message();
}

TEST_F(Paging, AnEmptyMapBeginsWhileCubesAreUnderWay) {
    ViewerLink link;
    viewer = &link;
    Start(false, 24);
    TakeFrames(kSteps + kTurn + 5);
    Ask(Command::kReset);
    TakeAll();
    EXPECT_TRUE(engine->status().ok()) << engine->status().message();
    EXPECT_EQ(Count(Kind::kReset), 1);
    EXPECT_EQ(Messages().find("scan repair"), std::string::npos) << Messages();
    const TriangleMesh mesh = engine->TakeMesh();
    ASSERT_GT(mesh.triangles.size(), 50000u);
    const BoxRoom hall = Hall();
    for (const Eigen::Vector3f& v : mesh.vertices)
        ASSERT_LT(std::abs(hall.SignedDistance(v.cast<double>())), 0.02) << v.transpose();
}

TEST_F(Paging, LiveCanBeLeftAtAnyTime) {
    for (const int frames : {1, kSteps, kSteps + kTurn + 10}) {
        Start(true, 24);
        for (int i = 0; i < frames && Next(); ++i) {
        }
        engine.reset();
        std::remove(path.c_str());
    }
}

// A locked database acts like a full disk. Saving stops while part of the map is paged out.
TEST_F(Paging, AFileThatTakesNothingAnyMoreCostsMemoryButNoMap) {
    constexpr int kAfter = 12;  // frames
    const auto end = [&] {
        TakeFrames(kAfter);
        stop = true;
        TakeAll();
        stop = false;
        EXPECT_TRUE(engine->status().ok()) << engine->status().message();
    };
    Start(false, 0);
    TakeFrames(kSteps);
    end();
    const TriangleMesh whole = engine->TakeMesh();

    Start(false, 24);
    TakeFrames(kSteps);
    auto database = Database::Open(path, Database::Access::kWrite);
    ASSERT_TRUE(database.value()->Execute("BEGIN IMMEDIATE").ok());
    end();
    EXPECT_NE(Messages().find("no longer saved"), std::string::npos);
    const TriangleMesh mesh = engine->TakeMesh();
    EXPECT_TRUE(engine->status().ok()) << engine->status().message();
    EXPECT_EQ(mesh.vertices.size(), whole.vertices.size());
    EXPECT_EQ(mesh.triangles.size(), whole.triangles.size());
}

}  // namespace
}  // namespace tessera
