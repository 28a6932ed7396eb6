// Which topics of a ROS recording are the depth and the colour images, and how their cameras stand
// to each other.
#pragma once

#include "core/status.h"
#include "recordings/recording.h"
#include "recordings/ros_contents.h"

namespace tessera {

// The topics that the user wants; empty: any.
struct RosTopics {
    std::string depth = {}, colour = {};
};

struct RosChoice {
    const RosStream* depth = nullptr;
    const RosStream* colour = nullptr;  // nullptr: none
};

// Depth: rather than infrared; a topic in whose frame there is also colour, which is then
// registered; then the one with the most images. Colour: rather than grey, of the depth's frame,
// and with the longest name in common. `depth` is nullptr if there is none. An error if a wanted
// topic has no such images.
Result<RosChoice> ChooseRosStreams(const RosContents& contents, const RosTopics& wanted);

// Fills in the cameras, T_colour_depth, camera_known, notes and warnings.
void FindRosCameras(const RosContents& contents, const RosChoice& choice, RecordingInfo& info);

}  // namespace tessera
