// Opens what a finished run read, so that its frames are the ones that the run saw.
#pragma once

#include <memory>
#include <string>

#include "core/status.h"
#include "io/frame_source.h"
#include "report/run_record.h"
#include "system/run_config.h"

namespace tessera {

// The settings that decide what frames a run saw: those of its source, the intrinsics that it used,
// and the vignetting and registration that it corrected. The others keep their defaults, as do keys
// that this version does not know.
RunConfig SourceSettings(const RunRecord& run);

// `moved_to`: the source's name now; empty: as it was. Errors: those of OpenSource; a camera, whose
// frames are gone.
Result<std::unique_ptr<FrameSource>> OpenSourceOf(const RunRecord& run,
                                                  const std::string& moved_to = {});

}  // namespace tessera
