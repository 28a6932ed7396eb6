#include "finish/decimate.h"

namespace tessera {

bool DecimationAvailable() { return false; }

double Decimate(TriangleMesh&, const std::vector<float>&, double, double) { return 0; }

double DecimateTo(TriangleMesh&, double) { return 0; }

}  // namespace tessera
