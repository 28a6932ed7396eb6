// Opens a run's source as seldom as the looks at it before the run allow: opening a large recording
// takes minutes.
#pragma once

#include <functional>
#include <memory>
#include <utility>

#include "core/status.h"
#include "io/frame_source.h"
#include "system/run_config.h"

namespace tessera {

// Owner thread only.
class KeptSource {
  public:
    using Open = std::function<Result<std::unique_ptr<FrameSource>>(const RunConfig&)>;
    explicit KeptSource(Open open) : open_(std::move(open)) {}

    // The source at its first frame. Opens it if `config.source` (with which the intrinsics in
    // `config.openni` change) is not as before, or if the source cannot seek. Valid until the next
    // call.
    Result<FrameSource*> With(const RunConfig& config) {
        if (!source_ || !(settings_ == config.source) || !source_->Seek(0)) {
            source_.reset();  // a file may not be open twice
            Result<std::unique_ptr<FrameSource>> opened = open_(config);
            if (!opened.ok()) return opened.status();
            source_ = std::move(opened.value());
            settings_ = config.source;
        }
        return source_.get();
    }

    // What With returned last.
    std::unique_ptr<FrameSource> Take() { return std::move(source_); }

  private:
    Open open_;
    std::unique_ptr<FrameSource> source_;
    FolderSourceConfig settings_;  // of `source_`
};

}  // namespace tessera
