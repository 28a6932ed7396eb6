// Joins the parts of a scan where views show places of two of them.
#pragma once

#include <string>
#include <vector>

#include "optimize/place_finder.h"
#include "optimize/scan_graph.h"

namespace tessera {

// Owner thread only.
class PartJoiner {
  public:
    explicit PartJoiner(ScanGraph& graph) : graph_(graph) {}

    // One view was found at these places, each in another part. Where enough such places agree, two
    // parts are joined. Returns a message for the user, usually empty.
    std::string JoinAt(const std::vector<PlaceFinder::Place>& places);

  private:
    std::string Join(std::span<const int> parts, int a, int b);

    ScanGraph& graph_;
    std::vector<CommonPlace> common_;  // of parts that are not joined yet
};

}  // namespace tessera
