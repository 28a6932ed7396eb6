// Replays the frames that a scan file holds, with the source's truth where it has it.
#pragma once

#include <memory>
#include <vector>

#include "io/frame_source.h"
#include "scan/scan_content.h"

namespace tessera {

class ScanSource : public FrameSource {
  public:
    // All frames are checked. Errors name the file; one without frames says how to keep them.
    static Result<std::unique_ptr<FrameSource>> Open(const std::string& path);

    const SourceInfo& info() const override { return info_; }
    ReadResult Read(Frame& frame) override;
    bool Seek(std::int64_t index) override;

  private:
    explicit ScanSource(std::unique_ptr<ScanFile> file, const ScanContent& content);

    std::unique_ptr<ScanFile> file_;
    SourceInfo info_;
    FrameStore decoder_;  // holds no frame
    std::vector<std::int64_t> keys_;
    std::vector<PathRecord> path_;
    std::size_t next_ = 0;
};

}  // namespace tessera
