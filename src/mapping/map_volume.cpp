#include "mapping/map_volume.h"

#include <fmt/format.h>

namespace tessera {

void MapVolume::Describe(ConfigParameters& p) {
    constexpr ConfigParameters::Range kWorld{-1e4, 1e4};
    p.Add("bounded", bounded,
          "map only what lies in this box of the world; the world is the first camera, x right, y "
          "down, "
          "z ahead");
    p.Add("min_x_m", min_x_m, kWorld, "m",
          "the box's left side, if bounded; the defaults are [D18]'s for desks");
    p.Add("min_y_m", min_y_m, kWorld, "m", "the box's upper side");
    p.Add("min_z_m", min_z_m, kWorld, "m", "the box's near side");
    p.Add("max_x_m", max_x_m, kWorld, "m", "the box's right side");
    p.Add("max_y_m", max_y_m, kWorld, "m", "the box's lower side");
    p.Add("max_z_m", max_z_m, kWorld, "m", "the box's far side");
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
