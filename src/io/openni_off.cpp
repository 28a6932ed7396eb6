// Stubs for builds without OpenNI2; they report that it is missing.
#include "io/openni_devices.h"
#include "io/openni_source.h"

namespace tessera {

Result<std::unique_ptr<FrameSource>> OpenOpenniSource(const std::string& name,
                                                      const OpenniConfig&) {
    return Status::Error(
        name + ": this build has no OpenNI2 support; install libopenni2-dev and build again");
}

OpenniListing ListOpenniDevices() {
    OpenniListing listing;
    listing.advice = {"off: install libopenni2-dev and build again"};
    return listing;
}

}  // namespace tessera
