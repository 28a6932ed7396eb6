// Frames of a smooth path through the box room, and settings for them.
#pragma once

#include "support/box_room.h"
#include "system/pipeline.h"

namespace tessera {

inline PipelineConfig SmallConfig() {
    PipelineConfig config;
    config.map.voxel_size_m = 0.02;
    config.map.truncation_m = 0.08;
    config.trackers.sdf.finest_step_px = 1;
    return config;
}

inline Frame RoomFrame(int i) {
    testing_support::BoxRoom room;
    room.has_ball = true;
    Frame frame =
        room.Render(testing_support::SmallCamera(), testing_support::SmoothPath(i), i / 30.0);
    frame.index = i;
    return frame;
}

}  // namespace tessera
