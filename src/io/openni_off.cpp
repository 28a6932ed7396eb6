// In place of everything that needs OpenNI2, in a build without it: says so.
#include "io/openni_devices.h"
#include "io/openni_source.h"

namespace tessera {

Result<std::unique_ptr<FrameSource>> OpenOpenniSource(const std::string& name,
                                                      const OpenniConfig&) {
    return Status::Error(name +
                         ": this build has no OpenNI2: install libopenni2-dev and build again");
}

OpenniListing ListOpenniDevices() {
    OpenniListing listing;
    listing.advice = {"off: install libopenni2-dev and build again"};
    return listing;
}

}  // namespace tessera
