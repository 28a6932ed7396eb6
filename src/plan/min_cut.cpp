#include "plan/min_cut.h"

#include <algorithm>
#include <limits>

namespace tessera {
namespace {

constexpr double kEmpty = 1e-12;  // capacity that is left by rounding

}  // namespace

MinCut::MinCut(std::size_t nodes) : source_(nodes), sink_(nodes + 1), from_(nodes + 2) {}

void MinCut::AddArcs(std::size_t a, std::size_t b, double there, double back) {
    from_[a].push_back(arcs_.size());
    arcs_.push_back({b, there});
    from_[b].push_back(arcs_.size());
    arcs_.push_back({a, back});
}

void MinCut::AddNode(std::size_t node, double first, double second) {
    AddArcs(source_, node, first, 0);
    AddArcs(node, sink_, second, 0);
}

void MinCut::AddPair(std::size_t a, std::size_t b, double cost) { AddArcs(a, b, cost, cost); }

// Distances from the source along arcs with capacity; false if the sink is cut off.
bool MinCut::Layer() {
    depth_.assign(from_.size(), -1);
    depth_[source_] = 0;
    std::vector<std::size_t> front{source_};
    for (std::size_t k = 0; k < front.size(); ++k)
        for (const std::size_t i : from_[front[k]])
            if (arcs_[i].rest > kEmpty && depth_[arcs_[i].to] < 0) {
                depth_[arcs_[i].to] = depth_[front[k]] + 1;
                front.push_back(arcs_[i].to);
            }
    return depth_[sink_] >= 0;
}

// One path from layer to layer, without recursion; returns what it carried, 0 if there is none.
double MinCut::Push() {
    std::vector<std::size_t> path;
    std::size_t node = source_;
    while (node != sink_) {
        std::size_t& next = next_[node];
        while (next < from_[node].size()) {
            const Arc& arc = arcs_[from_[node][next]];
            if (arc.rest > kEmpty && depth_[arc.to] == depth_[node] + 1) break;
            ++next;
        }
        if (next < from_[node].size()) {
            path.push_back(from_[node][next]);
            node = arcs_[path.back()].to;
        } else if (path.empty()) {
            return 0;
        } else {
            node = arcs_[path.back() ^ 1].to;
            path.pop_back();
            ++next_[node];
        }
    }
    double flow = std::numeric_limits<double>::infinity();
    for (const std::size_t i : path) flow = std::min(flow, arcs_[i].rest);
    for (const std::size_t i : path) {
        arcs_[i].rest -= flow;
        arcs_[i ^ 1].rest += flow;
    }
    return flow;
}

std::vector<bool> MinCut::Solve() {
    while (Layer()) {
        next_.assign(from_.size(), 0);
        while (Push() > 0) {
        }
    }
    std::vector<bool> first;
    for (std::size_t node = 0; node < source_; ++node) first.push_back(depth_[node] >= 0);
    return first;
}

}  // namespace tessera
