// A person of simple bodies who walks through a built-in scene: legs and arms swing with the pace.
#pragma once

#include <functional>
#include <string>

#include "synth/furniture.h"

namespace tessera {

// Where the walker is on the floor at each moment, metres; any time.
using Walk = std::function<Eigen::Vector2d(double time_s)>;

// 1.74 m tall, of class "person", facing where the walk leads. Owner thread only, while the scene
// is being built.
void AddWalker(AnalyticScene& scene, const std::string& name, const Walk& walk, Rgb8 shirt,
               Rgb8 trousers, std::uint64_t seed);

}  // namespace tessera
