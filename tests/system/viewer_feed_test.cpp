// Tests what the window receives about labels: the objects, and colours equal to those of the
// labelled mesh.
#include "system/viewer_feed.h"

#include <map>
#include <tuple>

#include "semantics/objects_file.h"
#include "system/engine_fixture.h"

namespace tessera {
namespace {

// Detects one object on the wall: first as a cup, then always as a book, of which it sees only the
// left half.
class FickleDetector : public Detector {
  public:
    Result<std::vector<Detection>> Detect(const Frame& frame) override {
        Detection d;
        const bool cup = seen_++ < kCups;
        d.name = cup ? "cup" : "book";
        d.probability = 0.9f;
        const int width = cup ? 60 : 34;
        d.box = {30, 20, 29.0f + static_cast<float>(width), 69};
        d.mask = Image<std::uint8_t>(width, 50, 1);
        EXPECT_GE(frame.colour.width(), 90);
        return std::vector<Detection>{d};
    }
    const std::vector<std::string>& class_names() const override { return names_; }

  private:
    static constexpr int kCups = 10;
    int seen_ = 0;
    std::vector<std::string> names_{"cup", "book"};
};

// Steps per voxel that distinguish vertex positions. Vertices are at least 1/1000 voxel apart.
constexpr float kSteps = 2000;
constexpr Rgb8 kCup{1, 200, 3}, kBook{4, 5, 220};

class ViewerFeedTest : public EngineTest {
  protected:
    ViewerFeedTest() {
        config.labels.classes = "cup=#01c803 book=#0405dc";
        config.meshing.min_component_triangles = 0;
        viewer = &link;
    }
    void MakeLabelled(std::int64_t frames) {
        EngineInput input = Input({.count = frames});
        auto detector = std::make_unique<FickleDetector>();
        LabelClasses classes = LabelClasses::Make(config.labels, detector->class_names()).value();
        input.labelling = {std::move(detector), std::move(classes)};
        engine = std::make_unique<LockstepEngine>(std::move(input));
    }
    // Reads the queues as the window does.
    void TakeMeshes() {
        MeshUpdate update;
        while (link.meshes.TryPop(update)) {
            if (update.clear) blocks.clear();
            for (GeometryBlock& block : update.blocks) blocks[block.id] = std::move(block);
        }
        std::vector<MapObject> objects;
        while (link.objects.TryPop(objects)) sent.push_back(std::move(objects));
    }
    bool NextTaken() {
        const bool more = Next();
        TakeMeshes();
        return more;
    }
    // Indexed by position, so that copies in neighbouring blocks count once.
    std::map<std::tuple<int, int, int>, Rgb8> Colours() const {
        std::map<std::tuple<int, int, int>, Rgb8> colours;
        for (const auto& [id, block] : blocks) {
            const BlockCoord sector = SectorOf(block.coord);
            for (const GeometryVertex& v : block.geometry.vertices) {
                const auto at = [&](float p, int s) {
                    return static_cast<int>(std::lround(
                        (p + static_cast<float>(s * kSectorBlocks * kBlockSide)) * kSteps));
                };
                const auto& p = v.position_voxels;
                const auto [entry, is_new] = colours.try_emplace(
                    {at(p[0], sector.x), at(p[1], sector.y), at(p[2], sector.z)},
                    v.mark.label_colour);
                EXPECT_TRUE(is_new || entry->second == v.mark.label_colour)
                    << "copies of a vertex differ, block " << id;
            }
        }
        return colours;
    }
    std::int64_t CountOf(const Rgb8& colour) const {
        std::int64_t n = 0;
        for (const auto& [at, c] : Colours()) n += c == colour;
        return n;
    }

    ViewerLink link;
    std::map<BlockId, GeometryBlock> blocks;
    std::vector<std::vector<MapObject>> sent;
};

// The object is confirmed, then changes its class while one half gets no votes. The data sent block
// by block must always match the whole mesh.
TEST_F(ViewerFeedTest, ColoursByLabelAreThoseOfTheMesh) {
    MakeLabelled(30);
    std::int64_t most_cups = 0;
    while (NextTaken()) most_cups = std::max(most_cups, CountOf(kCup));
    EXPECT_GT(most_cups, 500);
    EXPECT_EQ(CountOf(kCup), 0);
    const auto colours = Colours();
    const double voxel_m = config.pipeline.map.voxel_size_m;
    const TriangleMesh mesh = engine->TakeMesh();
    std::int64_t books = 0, found = 0;
    for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
        const Eigen::Vector3d at = mesh.vertices[i].cast<double>() / voxel_m * kSteps;
        const auto there = colours.find({static_cast<int>(std::lround(at.x())),
                                         static_cast<int>(std::lround(at.y())),
                                         static_cast<int>(std::lround(at.z()))});
        if (there == colours.end()) continue;  // rounded to a different position
        ++found;
        books += mesh.labels[i].class_id != 0;
        const Rgb8 expected =
            mesh.labels[i].class_id == 2 ? kBook : NoCategoryColour(mesh.colours[i]);
        ASSERT_EQ(there->second, expected) << i;
    }
    EXPECT_GT(books, 500);
    EXPECT_GT(static_cast<double>(found), 0.95 * static_cast<double>(mesh.vertices.size()));
}

// They were measured on all of it before.
TEST_F(ViewerFeedTest, TheFinalMeshHasItsLabelsAndNoObjectsAreSentWithIt) {
    config.live.mesh_blocks = 100000;
    MakeLabelled(30);
    while (NextTaken()) {
    }
    const auto colours = Colours();
    engine->KeepMap();
    engine->TakeMesh();
    sent.clear();
    blocks.clear();
    for (bool all = false; !all; TakeMeshes()) all = engine->SendFinalMesh();
    EXPECT_EQ(Colours(), colours);
    EXPECT_GT(CountOf(kBook), 500);
    EXPECT_TRUE(sent.empty());
}

TEST_F(ViewerFeedTest, ObjectsAreSentOnceTheyAreKnown) {
    MakeLabelled(30);
    while (NextTaken()) {
    }
    ASSERT_GE(sent.size(), 1u);
    for (const auto& objects : sent)
        for (const MapObject& o : objects) {
            EXPECT_EQ(o.id, 1);
            EXPECT_GE(o.observations, config.labels.min_observations);
        }
    engine->TakeMesh();
    ASSERT_EQ(engine->objects().size(), 1u);
    EXPECT_EQ(engine->objects()[0].class_name, "book");
    EXPECT_EQ(engine->objects()[0].observations, 30);
}

TEST_F(ViewerFeedTest, WithoutLabelsNothingIsSaidOfThem) {
    Make(false, {.count = 3});
    while (NextTaken()) {
    }
    EXPECT_TRUE(sent.empty());
    EXPECT_EQ(CountOf({}), static_cast<std::int64_t>(Colours().size()));
}

}  // namespace
}  // namespace tessera
