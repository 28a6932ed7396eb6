// Observed objects for the tests of instances.
#pragma once

#include <map>
#include <utility>

#include "semantics/instances.h"

namespace tessera {

inline const Eigen::AlignedBox3d kBox(Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(1, 1, 1));

inline ObservedObject Seen(int class_id, std::map<InstanceId, int> overlaps = {},
                           int pixels = 100) {
    return {class_id, 0.9f, pixels, std::move(overlaps), kBox, {}, pixels};
}

// An object observed until it is confirmed, at its own position.
inline InstanceId Confirmed(Instances& instances, int class_id) {
    ObservedObject seen = Seen(class_id);
    seen.box.translate(Eigen::Vector3d(2.0 * instances.last(), 0, 0));
    const InstanceId id = instances.Match({seen}, {})[0];
    seen.overlaps = {{id, 90}};
    for (int i = 0; i < 12; ++i) instances.Match({seen}, {{id, {95}}});
    return id;
}

}  // namespace tessera
