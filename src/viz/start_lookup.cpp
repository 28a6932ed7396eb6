#include "viz/start_lookup.h"

#include <utility>

namespace tessera {

StartLookup::StartLookup(const StartServices& services)
    : examiner_(1,
                [this, &services](std::string& path) {
                    findings_.Push({path, services.examine(path)});
                }),
      lister_(1, [this, &services](char&) { listings_.Push(services.list_cameras()); }) {}

bool StartLookup::Update() {
    bool any = false;
    while (findings_.TryPop(examined_)) any = true;
    OpenniListing listing;
    while (listings_.TryPop(listing)) {
        cameras_ = std::move(listing);
        any = true;
    }
    return any;
}

void StartLookup::Examine(const std::string& path) {
    // What is wrong may have been put right.
    if (path != asked_ || examined_.finding.failed)
        examiner_.PushNewest(std::string(asked_ = path));
}

const PathFinding* StartLookup::FindingOf(const std::string& path) const {
    return path == examined_.path ? &examined_.finding : nullptr;
}

void StartLookup::ListCameras() {
    cameras_asked_ = true;
    cameras_.reset();
    lister_.PushNewest(0);
}

}  // namespace tessera
