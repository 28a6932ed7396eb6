#include "io/corrected_depth.h"

#include <utility>

namespace tessera {
namespace {

class CorrectedDepth : public FrameSource {
  public:
    CorrectedDepth(std::unique_ptr<FrameSource> source, const DepthDistortion& distortion)
        : source_(std::move(source)),
          correction_(distortion, source_->info().camera.width, source_->info().camera.height) {}

    const SourceInfo& info() const override { return source_->info(); }
    ReadResult Read(Frame& frame) override {
        ReadResult result = source_->Read(frame);
        if (result.status == ReadStatus::kOk)
            correction_.Apply(source_->info().depth_units_per_m, frame.depth_m);
        return result;
    }
    bool Seek(std::int64_t index) override { return source_->Seek(index); }
    std::vector<double> Stamps_s() const override { return source_->Stamps_s(); }

  private:
    std::unique_ptr<FrameSource> source_;
    DepthCorrection correction_;
};

}  // namespace

std::unique_ptr<FrameSource> CorrectDepth(std::unique_ptr<FrameSource> source,
                                          const DepthDistortion& distortion) {
    if (distortion.empty()) return source;
    return std::make_unique<CorrectedDepth>(std::move(source), distortion);
}

}  // namespace tessera
