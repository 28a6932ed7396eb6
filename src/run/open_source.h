// Opens a frame source from the SOURCE argument.
#pragma once

#include <atomic>
#include <memory>
#include <string>

#include "core/status.h"
#include "io/frame_source.h"
#include "system/run_config.h"

namespace tessera {

// Whether the source is a camera, which does not wait for the program.
bool IsLiveSource(const std::string& name);

// Overrides the pinhole that a source of any kind says it has.
void UseCamera(const PinholeCamera& camera, RunConfig& config);

// "synthetic:NAME", "synthetic:FILE.obj" (a model), "openni2:[URI]" (a camera), "FILE.oni",
// "pipe:-", "pipe:PATH" (frames from another program), "FILE.klg", "FILE.scan", or a folder of
// images. `stop`, if given, ends the wait for a program that sends frames. Errors name the source
// and list the kinds of source that exist.
Result<std::unique_ptr<FrameSource>> OpenSource(const std::string& name, const RunConfig& config,
                                                const std::atomic<bool>* stop = nullptr);

}  // namespace tessera
