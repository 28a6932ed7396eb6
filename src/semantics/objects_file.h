// Labelled objects of a finished run, for programs that display its mesh or split it: reads
// objects.json, computes vertex colours, extracts single objects. Pure functions, thread-safe.
#pragma once

#include "semantics/map_object.h"

namespace tessera {

// Reads what ObjectsJson writes: all fields of MapObject except `vertices`. Errors name the file
// and the object.
Result<std::vector<MapObject>> ReadObjects(const std::string& path);

// Returns colours that replace those of the scene. Vertices with a class get its colour (from
// `objects`, or DistinctColour if the class is not among them). The others get a pale grey of the
// scene's brightness.
std::vector<Rgb8> CategoryColours(const TriangleMesh& labelled,
                                  const std::vector<MapObject>& objects);

// Colour of a vertex without a class: a pale grey of the scene's brightness.
Rgb8 NoCategoryColour(const Rgb8& scene);
inline constexpr Rgb8 kNoSceneColour{200, 200, 200};  // of a vertex that has no scene colour either

// Returns the triangles whose three corners belong to the instance, with their vertices. May be
// empty.
TriangleMesh ExtractInstance(const TriangleMesh& labelled, int id);

}  // namespace tessera
