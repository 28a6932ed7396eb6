// The scenes that come with the program, each made by code: nothing is read from disk.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/status.h"
#include "synth/camera_path.h"
#include "synth/scene.h"

namespace tessera {

struct StagedScene {
    std::unique_ptr<const Scene> scene;
    CameraPath path;
    std::string description;
};

// desk, room, flat, corridor, floor, corner, wall, people, chair, door: in the order to present
// them.
std::vector<std::string> BuiltinSceneNames();

// World frame: z up, the floor at z = 0. An unknown name is an error that lists the known ones.
//   desk      a desk in a room's corner: two monitors, keyboard, laptop, books, cups. 10 s, 2 m.
//   room      5 m x 4 m, furnished; one turn that ends where it began. 24 s.
//   flat      two furnished rooms of 7 m x 6 m, joined by two doorways; once around, 30 m. 80 s.
//   corridor  40 m long with doors, pillars, posters and chairs; walked from end to end. 88 s.
//   floor     a patterned floor only: texture without structure. 10 s.
//   corner    three bare bright walls: structure without texture. 10 s.
//   wall      one bare wall: neither. 10 s.
// In these something moves; it is no part of their exact surface:
//   people    the room, with two people walking about in view; one stands for three seconds. 24 s.
//   chair     the room; a chair is moved between seconds 5 and 8, and stays there. 14 s.
//   door      the flat; a door between its rooms opens between seconds 4 and 6. 12 s.
Result<StagedScene> MakeBuiltinScene(const std::string& name);

// The single builders, for the table in builtin_scenes.cpp.
StagedScene MakeDesk();
StagedScene MakeRoom();
StagedScene MakeFlat();
StagedScene MakeCorridor();
StagedScene MakeFloor();
StagedScene MakeCorner();
StagedScene MakeWall();
StagedScene MakePeople();
StagedScene MakeChair();
StagedScene MakeDoor();

}  // namespace tessera
