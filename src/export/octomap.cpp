#include "export/octomap.h"

#include <fmt/format.h>

#include <array>
#include <new>

#include "io/file.h"

namespace tessera {
namespace {

constexpr int kDepth = 16;                // of OctoMap's trees
constexpr int kHalf = 1 << (kDepth - 1);  // cells from the tree's lowest corner to the origin

// The two bits of a child. Two zero bits: there is none.
enum class Child : unsigned { kNone = 0, kFree = 1, kOccupied = 2, kInner = 3 };

// The tree in depth-first order: two bytes per inner node, which hold its eight children, child 0
// in the lowest bits. The bits of a child's number are its halves along x, y and z.
class Tree {
  public:
    explicit Tree(const Occupancy& occupancy)
        : occupancy_(occupancy), size_(occupancy.grid.size.cast<std::int64_t>()) {
        const Eigen::Vector3i low = -(occupancy.grid.first.array() + kHalf);
        root_ = Add(low.cast<std::int64_t>(), kDepth);
    }

    const std::string& bytes() const { return bytes_; }
    std::size_t nodes() const { return root_ == Child::kNone ? 0 : nodes_ + 1; }

  private:
    // Appends the cube of 2^level cells whose lowest cell is `low`, if it is an inner node.
    Child Add(const Eigen::Matrix<std::int64_t, 3, 1>& low, int level) {
        const std::int64_t side = std::int64_t{1} << level;
        if ((low.array() + side <= 0).any() || (low.array() >= size_.array()).any())
            return Child::kNone;
        if (level == 0) return Leaf(low.cast<int>());
        const std::size_t at = bytes_.size(), nodes_before = nodes_;
        bytes_.append(2, '\0');
        std::array<Child, 8> children;
        unsigned bits = 0;
        bool equal = true;
        for (int i = 0; i < 8; ++i) {
            const Eigen::Matrix<std::int64_t, 3, 1> half(i & 1, i >> 1 & 1, i >> 2);
            const Child child = Add(low + side / 2 * half, level - 1);
            children[static_cast<std::size_t>(i)] = child;
            bits |= static_cast<unsigned>(child) << 2 * i;
            nodes_ += child != Child::kNone;
            equal &= child == children[0] && child != Child::kInner;
        }
        if (equal) {
            bytes_.resize(at);
            nodes_ = nodes_before;
            return children[0];
        }
        bytes_[at] = static_cast<char>(bits & 255);
        bytes_[at + 1] = static_cast<char>(bits >> 8);
        return Child::kInner;
    }

    Child Leaf(const Eigen::Vector3i& cell) const {
        switch (occupancy_.At(cell.x(), cell.y(), cell.z())) {
            case CellState::kFree: return Child::kFree;
            case CellState::kOccupied: return Child::kOccupied;
            default: return Child::kNone;
        }
    }

    const Occupancy& occupancy_;
    const Eigen::Matrix<std::int64_t, 3, 1> size_;
    std::string bytes_;
    std::size_t nodes_ = 0;  // without the root
    Child root_ = Child::kNone;
};

}  // namespace

Status WriteOctomap(const std::string& path, const Occupancy& occupancy) {
    const CellGrid& grid = occupancy.grid;
    if ((grid.first.array() < -kHalf).any() || ((grid.first + grid.size).array() > kHalf).any())
        return Status::Error(
            fmt::format("{}: OctoMap ends {} cells, {:g} m, from the origin; take a smaller box or "
                        "a coarser resolution",
                        path, kHalf, kHalf * grid.resolution_m));
    try {
        const Tree tree(occupancy);
        AtomicFile file(path);
        file.Write(fmt::format(
            "# Octomap OcTree binary file\n"
            "# (feel free to add / change comments, but leave the first line as it is!)\n"
            "#\n"
            "id OcTree\n"
            "size {}\n"
            "res {:.9g}\n"
            "data\n",
            tree.nodes(), grid.resolution_m));
        file.Write(tree.bytes());
        return file.Commit();
    } catch (const std::bad_alloc&) {
        return Status::Error(path +
                             ": the tree does not fit in memory; take a smaller box or a coarser "
                             "resolution");
    }
}

}  // namespace tessera
