// Replays the frames of a scan file, with the source's ground truth where available.
#pragma once

#include <memory>
#include <vector>

#include "io/frame_source.h"
#include "scan/scan_content.h"

namespace tessera {

class ScanSource : public ListedSource {
  public:
    // Checks all frames. Errors name the file; if it has no frames, the error says how to keep
    // them.
    static Result<std::unique_ptr<FrameSource>> Open(const std::string& path);

    ReadResult Read(Frame& frame) override;
    std::vector<double> Stamps_s() const override;

  private:
    void FindReadouts();
    explicit ScanSource(std::unique_ptr<ScanFile> file, const ScanContent& content);

    std::unique_ptr<ScanFile> file_;
    FrameStore decoder_;  // used for decoding only
    std::vector<std::int64_t> keys_;
    std::vector<PathRecord> path_;
};

}  // namespace tessera
