#include "mapping/map_volume.h"

#include <fmt/format.h>

namespace tessera {

void MapVolume::Describe(ConfigParameters& p) {
    constexpr ConfigParameters::Range kWorld{-1e4, 1e4};
    p.Add(
        "bounded", bounded,
        "map only inside this box of the world frame, which is the first camera's frame: x right, "
        "y down, z forward");
    p.Add("min_x_m", min_x_m, kWorld, "m",
          "left side of the box, if bounded; the defaults are those of [D18] for desks");
    p.Add("min_y_m", min_y_m, kWorld, "m", "upper side of the box");
    p.Add("min_z_m", min_z_m, kWorld, "m", "near side of the box");
    p.Add("max_x_m", max_x_m, kWorld, "m", "right side of the box");
    p.Add("max_y_m", max_y_m, kWorld, "m", "lower side of the box");
    p.Add("max_z_m", max_z_m, kWorld, "m", "far side of the box");
}

Status MapVolume::Validate() const {
    struct Axis {
        char name;
        double low, high;
    };
    for (const Axis& a :
         {Axis{'x', min_x_m, max_x_m}, {'y', min_y_m, max_y_m}, {'z', min_z_m, max_z_m}})
        if (bounded && !(a.low < a.high))
            return Status::Error(
                fmt::format("mapping.volume.max_{0}_m: {1} is not above min_{0}_m: {2}", a.name,
                            a.high, a.low));
    return Status::Ok();
}

}  // namespace tessera
