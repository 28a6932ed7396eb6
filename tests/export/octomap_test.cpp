#include "export/octomap.h"

#include <gtest/gtest.h>

#include <map>

#ifdef TESSERA_HAVE_OCTOMAP
#include <octomap/octomap.h>

#include <memory>
#endif

#include "core/input_file.h"
#include "mapping/analytic_fields.h"
#include "support/temp_folder.h"

namespace tessera {
namespace {

Occupancy Empty(const Eigen::Vector3i& first, const Eigen::Vector3i& size) {
    const CellGrid grid{Eigen::Isometry3d::Identity(), first, size, 0.05};
    return {grid, std::vector<CellState>(grid.cells(), CellState::kUnknown)};
}

// Single cells at random, and solid parts that merge. Crosses the origin.
Occupancy Mixed() {
    Occupancy occupancy = Empty({-13, -5, -3}, {30, 21, 12});
    for (std::size_t i = 0; i < occupancy.cells.size(); ++i)
        occupancy.cells[i] =
            static_cast<CellState>(testing_support::Mix(static_cast<std::uint32_t>(i)) % 3);
    for (int z = 3; z < 12; ++z)
        for (int y = 5; y < 21; ++y)
            for (int x = 13; x < 30; ++x)
                occupancy.cells[occupancy.grid.Index(x, y, z)] =
                    x < 21 ? CellState::kFree : CellState::kOccupied;
    return occupancy;
}

// A second, plain reader: marks the leaves' cells in `leaves` and counts the nodes.
class Reader {
  public:
    explicit Reader(const std::string& file) : bytes_(file.substr(file.find("data\n") + 5)) {
        if (!bytes_.empty()) Read({-32768, -32768, -32768}, 32768);
        EXPECT_EQ(at_, bytes_.size());
    }
    CellState At(const Eigen::Vector3i& cell) const {
        const auto found = leaves.find({cell.x(), cell.y(), cell.z()});
        return found == leaves.end() ? CellState::kUnknown : found->second;
    }
    std::map<std::array<int, 3>, CellState> leaves;
    int nodes = 0;

  private:
    void Read(const Eigen::Vector3i& low, int half) {
        ++nodes;
        ASSERT_LE(at_ + 2, bytes_.size());
        const int bits = static_cast<unsigned char>(bytes_[at_]) |
                         static_cast<unsigned char>(bytes_[at_ + 1]) << 8;
        at_ += 2;
        for (int child = 0; child < 8; ++child) {
            const Eigen::Vector3i corner =
                low + half * Eigen::Vector3i(child & 1, child >> 1 & 1, child >> 2);
            const int kind = bits >> 2 * child & 3;
            if (kind == 3) {
                Read(corner, half / 2);
            } else if (kind != 0) {
                ++nodes;
                ASSERT_LE(half, 16);  // no larger cube is solid here
                for (int i = 0; i < half * half * half; ++i)
                    leaves[{corner.x() + i % half, corner.y() + i / half % half,
                            corner.z() + i / half / half}] =
                        kind == 1 ? CellState::kFree : CellState::kOccupied;
            }
        }
    }
    const std::string bytes_;
    std::size_t at_ = 0;
};

std::string FileOf(const Occupancy& occupancy) {
    const TempFolder folder;
    const Status status = WriteOctomap(folder / "a.bt", occupancy);
    EXPECT_TRUE(status.ok()) << status.message();
    return ReadWholeFile(folder / "a.bt", 1 << 24).value();
}

TEST(Octomap, EveryCellIsInTheTreeAndNothingElse) {
    const Occupancy occupancy = Mixed();
    const std::string file = FileOf(occupancy);
    EXPECT_EQ(file.find("# Octomap OcTree binary file\n"), 0u);
    EXPECT_NE(file.find("\nid OcTree\nsize "), std::string::npos);
    EXPECT_NE(file.find("\nres 0.05\ndata\n"), std::string::npos);
    const Reader reader(file);
    EXPECT_NE(file.find("\nsize " + std::to_string(reader.nodes) + "\n"), std::string::npos);
    std::size_t known = 0;
    for (int z = 0; z < 12; ++z)
        for (int y = 0; y < 21; ++y)
            for (int x = 0; x < 30; ++x) {
                const CellState state = occupancy.At(x, y, z);
                ASSERT_EQ(reader.At(occupancy.grid.first + Eigen::Vector3i(x, y, z)), state);
                known += state != CellState::kUnknown;
            }
    EXPECT_EQ(reader.leaves.size(), known);
}

TEST(Octomap, EqualCellsMergeAndAnEmptyGridIsAnEmptyTree) {
    // One leaf below 12 inner nodes: a cube of 8 cells that begins at a multiple of 8.
    Occupancy solid = Empty({8, -16, 0}, {8, 8, 8});
    solid.cells.assign(solid.cells.size(), CellState::kOccupied);
    EXPECT_NE(FileOf(solid).find("\nsize 14\n"), std::string::npos);
    EXPECT_EQ(Reader(FileOf(solid)).leaves.size(), 512u);
    solid.cells[100] = CellState::kFree;
    EXPECT_NE(FileOf(solid).find("\nsize 38\n"), std::string::npos);
    const std::string nothing = FileOf(Empty({0, 0, 0}, {3, 3, 3}));
    EXPECT_NE(nothing.find("\nsize 0\n"), std::string::npos);
    EXPECT_EQ(nothing.substr(nothing.find("data\n")), "data\n");
}

TEST(Octomap, CellsBeyondTheTreeAndBadPathsAreRefused) {
    const TempFolder folder;
    EXPECT_TRUE(WriteOctomap(folder / "a.bt", Empty({32766, 0, -32768}, {2, 1, 1})).ok());
    for (const Eigen::Vector3i& first : {Eigen::Vector3i(32767, 0, 0), {0, -32769, 0}})
        EXPECT_NE(
            WriteOctomap(folder / "a.bt", Empty(first, {2, 1, 1})).message().find("smaller box"),
            std::string::npos);
    EXPECT_NE(WriteOctomap(folder / "none/a.bt", Mixed()).message().find("none/a.bt"),
              std::string::npos);
}

TEST(Octomap, OctomapReadsTheFile) {
#ifdef TESSERA_HAVE_OCTOMAP
    const TempFolder folder;
    const Occupancy occupancy = Mixed();
    ASSERT_TRUE(WriteOctomap(folder / "a.bt", occupancy).ok());
    octomap::OcTree tree(0.1);
    ASSERT_TRUE(tree.readBinary(folder / "a.bt"));
    EXPECT_DOUBLE_EQ(tree.getResolution(), 0.05);
    for (int z = -2; z < 14; ++z)
        for (int y = -2; y < 23; ++y)
            for (int x = -2; x < 32; ++x) {
                const bool inside = x >= 0 && y >= 0 && z >= 0 && x < 30 && y < 21 && z < 12;
                const CellState state = inside ? occupancy.At(x, y, z) : CellState::kUnknown;
                const Eigen::Vector3d p = occupancy.grid.Centre(x, y, z);
                const octomap::OcTreeNode* node = tree.search(p.x(), p.y(), p.z());
                ASSERT_EQ(node != nullptr, state != CellState::kUnknown);
                if (node == nullptr) continue;
                ASSERT_EQ(tree.isNodeOccupied(node), state == CellState::kOccupied);
            }
    const std::size_t nodes = tree.size();
    tree.prune();
    EXPECT_EQ(tree.size(), nodes);
    // OctoMap's own file of the same tree.
    ASSERT_TRUE(tree.writeBinary(folder / "b.bt"));
    const auto data = [&](const char* name) {
        const std::string file = ReadWholeFile(folder / name, 1 << 24).value();
        return file.substr(file.find("data\n"));
    };
    EXPECT_TRUE(data("a.bt") == data("b.bt"));
#else
    GTEST_SKIP() << "needs liboctomap-dev";
#endif
}

}  // namespace
}  // namespace tessera
