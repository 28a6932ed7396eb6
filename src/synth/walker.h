// A person made of simple bodies who walks through a built-in scene, with swinging legs and arms.
#pragma once

#include <functional>
#include <string>

#include "synth/furniture.h"

namespace tessera {

// Position of the walker on the floor at a time, metres; any time is valid.
using Walk = std::function<Eigen::Vector2d(double time_s)>;

// 1.74 m tall, class "person", facing in the walking direction. Owner thread only, while the scene
// is being built.
void AddWalker(AnalyticScene& scene, const std::string& name, const Walk& walk, Rgb8 shirt,
               Rgb8 trousers, std::uint64_t seed);

}  // namespace tessera
