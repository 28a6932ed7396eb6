// Furnished interiors shared by several built-in scenes. Owner thread only, while the scene is
// being built.
#pragma once

#include "synth/furniture.h"

namespace tessera {

// 5 m x 4 m: x in [0, 5], y in [0, 4].
void AddRoom(Furnisher& add);
Lighting RoomLighting();

// Two rooms of 7 m x 6 m, separated by a wall at x = 7 with doorways at y in [0.8, 1.8] and [4.2,
// 5.2], 2.05 m high.
void AddFlat(Furnisher& add);
Lighting FlatLighting();

}  // namespace tessera
