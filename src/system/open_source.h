// From what a person writes as SOURCE to a frame source.
#pragma once

#include <memory>
#include <string>

#include "core/status.h"
#include "io/frame_source.h"
#include "system/run_config.h"

namespace tessera {

// "synthetic:NAME", a model "synthetic:FILE.obj", a camera "openni2:[URI]", "FILE.oni", or a folder
// of images. Errors name the source and what can be given; kinds of source that this version does
// not read are refused by name.
Result<std::unique_ptr<FrameSource>> OpenSource(const std::string& name, const RunConfig& config);

}  // namespace tessera
