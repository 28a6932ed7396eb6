// A finished run's labelled objects, for whoever shows or takes apart its mesh: read from
// objects.json, as colours, and as meshes of their own. Pure functions, thread-safe.
#pragma once

#include "semantics/map_object.h"

namespace tessera {

// What ObjectsJson wrote; the fields of MapObject but `vertices`. Errors name the file and what is
// wrong in it.
Result<std::vector<MapObject>> ReadObjects(const std::string& path);

// In place of the scene's colours: vertices with a class get its colour (of `objects`, or
// DistinctColour for a class that is not among them), the others a pale grey of the scene's
// brightness.
std::vector<Rgb8> CategoryColours(const TriangleMesh& labelled,
                                  const std::vector<MapObject>& objects);

// What a vertex without a class looks like among such: a pale grey as bright as the scene is there.
Rgb8 NoCategoryColour(const Rgb8& scene);
inline constexpr Rgb8 kNoSceneColour{200, 200, 200};  // of one that has no colour either

// The triangles of which all corners are that instance's, with their vertices; empty if there are
// none.
TriangleMesh ExtractInstance(const TriangleMesh& labelled, int id);

}  // namespace tessera
