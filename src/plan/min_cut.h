// The cheapest division of a graph's nodes into two sides, by Dinic's maximum flow. Owner thread
// only.
#pragma once

#include <cstddef>
#include <vector>

namespace tessera {

class MinCut {
  public:
    explicit MinCut(std::size_t nodes);

    // What it costs not to have this node on the first side, and on it. Not negative.
    void AddNode(std::size_t node, double first, double second);
    // What it costs to have the two on different sides.
    void AddPair(std::size_t a, std::size_t b, double cost);
    // For each node: on the first side? May be called once.
    std::vector<bool> Solve();

  private:
    struct Arc {
        std::size_t to;
        double rest;  // capacity that is left
    };
    void AddArcs(std::size_t a, std::size_t b, double there, double back);
    bool Layer();
    double Push();

    std::size_t source_, sink_;
    std::vector<Arc> arcs_;  // arc i ^ 1 is the reverse of arc i
    std::vector<std::vector<std::size_t>> from_;
    std::vector<int> depth_;
    std::vector<std::size_t> next_;  // per node: the first arc that may still lead on
};

}  // namespace tessera
