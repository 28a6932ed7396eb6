// What the viewer's script reads: script elements with JSON and with base64. Pure functions,
// thread-safe.
#pragma once

#include <string>

#include "report/report_data.h"

namespace tessera {

// HTML: the elements "data" (JSON) and, as far as there is something, "vertices", "corners",
// "poses" (per pose 8 floats: seconds since the begin, position, quaternion xyzw), "tracked" and
// "truth" (3 floats each, in the run's world).
std::string ViewerData(const ReportData& data, const TriangleMesh& mesh);

}  // namespace tessera
