#include "finish/boundary_loops.h"

#include <algorithm>

#include "finish/mesh_edges.h"

namespace tessera {
namespace {

constexpr std::uint32_t kNoCorner = 0xffffffffu;

class LoopFinder {
  public:
    explicit LoopFinder(const TriangleMesh& mesh)
        : mesh_(mesh), neighbours_(TriangleNeighbours(mesh)), place_(mesh.vertices.size(), kOff) {}

    std::vector<BoundaryLoop> Find() {
        std::vector<bool> taken(3 * mesh_.triangles.size());
        for (std::uint32_t t = 0; t < mesh_.triangles.size(); ++t)
            for (std::uint32_t k = 0; k < 3; ++k)
                if (neighbours_[t][k] == kNoTriangle && !taken[3 * t + k]) Follow({t, k}, taken);
        return std::move(loops_);
    }

  private:
    struct Side {  // of a triangle, from corner k to corner k + 1
        std::uint32_t t, k;
    };
    static constexpr std::uint32_t kOff = 0xffffffffu;

    std::uint32_t From(Side s) const { return mesh_.triangles[s.t][s.k]; }
    std::uint32_t To(Side s) const { return mesh_.triangles[s.t][(s.k + 1) % 3]; }

    // From one side at the border to the one that ends where this one begins, round their common
    // vertex through the triangles that share it. False where the triangles do not agree.
    bool Step(Side& side) const {
        const std::uint32_t pivot = From(side);
        Side at{side.t, (side.k + 2) % 3};  // ends at the pivot
        for (std::size_t steps = 0; steps <= mesh_.triangles.size(); ++steps) {
            if (To(at) != pivot) return false;
            const std::uint32_t next = neighbours_[at.t][at.k];
            if (next == kNoTriangle) {
                side = at;
                return true;
            }
            std::uint32_t from_pivot = kNoCorner;
            for (std::uint32_t k = 0; k < 3; ++k)
                if (neighbours_[next][k] == at.t && From({next, k}) == pivot &&
                    To({next, k}) == From(at))
                    from_pivot = k;
            if (from_pivot == kNoCorner) return false;
            at = {next, (from_pivot + 2) % 3};
        }
        return false;
    }

    // Walks against the triangles' own order. `chain_` holds what is not yet part of a loop.
    void Follow(Side side, std::vector<bool>& taken) {
        chain_.clear();
        bool goes_on = true;
        while (goes_on && !taken[3 * side.t + side.k]) {
            taken[3 * side.t + side.k] = true;
            Append(To(side));
            goes_on = Step(side);
        }
        // The chain has come back to its first side; what cannot be followed is no loop.
        if (goes_on && chain_.size() >= 3) loops_.push_back(chain_);
        for (const std::uint32_t v : chain_) place_[v] = kOff;
    }

    void Append(std::uint32_t vertex) {
        if (place_[vertex] != kOff) {
            const auto first = chain_.begin() + place_[vertex];
            if (chain_.end() - first >= 3) loops_.emplace_back(first, chain_.end());
            for (auto v = first; v != chain_.end(); ++v) place_[*v] = kOff;
            chain_.erase(first, chain_.end());
        }
        place_[vertex] = static_cast<std::uint32_t>(chain_.size());
        chain_.push_back(vertex);
    }

    const TriangleMesh& mesh_;
    const std::vector<std::array<std::uint32_t, 3>> neighbours_;
    std::vector<std::uint32_t> place_;  // of each vertex in the chain
    BoundaryLoop chain_;
    std::vector<BoundaryLoop> loops_;
};

}  // namespace

std::vector<BoundaryLoop> FindBoundaryLoops(const TriangleMesh& mesh) {
    return LoopFinder(mesh).Find();
}

}  // namespace tessera
