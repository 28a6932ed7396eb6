#include "cuda/open_device.h"

#include <fmt/format.h>

#include "cuda/device_pipeline.h"
#include "cuda/gpus.h"

namespace tessera {
namespace {

using TESSERA_DEVICE::backend::CountGpus;
using TESSERA_DEVICE::backend::Gpu;
using TESSERA_DEVICE::backend::UseGpu;

constexpr int kLeastMajor = 7, kLeastMinor = 5;
constexpr std::size_t kMega = std::size_t{1} << 20;
// An empty map, one frame and temporary buffers.
constexpr std::size_t kLeastBytes = 64 * kMega;

std::string Describe(const Gpu& gpu) {
    return fmt::format("{}, compute capability {}.{}, {} of {} MB free", gpu.name, gpu.major,
                       gpu.minor, gpu.free_bytes / kMega, gpu.total_bytes / kMega);
}

}  // namespace

std::string DescribeGpus() {
    const char* reason = nullptr;
    const int count = CountGpus(reason);
    if (count == 0) return fmt::format("built in, but no GPU is available: {}", reason);
    Gpu gpu;
    std::string text = UseGpu(0, gpu, reason) ? Describe(gpu) : reason;
    if (count > 1) text += fmt::format("; {} more", count - 1);
    return text + " (used only with --device cuda; not yet tested on a GPU)";
}

Result<std::unique_ptr<Backend>> OpenGpu(double memory_limit_mb) {
    const char* reason = nullptr;
    Gpu gpu;
    if (CountGpus(reason) == 0 || !UseGpu(0, gpu, reason))
        return Status::Error(fmt::format(
            "--device cuda: no GPU is available: {}; omit --device to run on the CPU", reason));
    if (gpu.major < kLeastMajor || (gpu.major == kLeastMajor && gpu.minor < kLeastMinor))
        return Status::Error(fmt::format(
            "--device cuda: {}: compute capability {}.{} or higher is required; omit --device to "
            "run on the CPU",
            Describe(gpu), kLeastMajor, kLeastMinor));
    const std::size_t limit = memory_limit_mb > 0
                                  ? static_cast<std::size_t>(memory_limit_mb) * kMega
                                  : gpu.free_bytes / 10 * 9;
    if (limit < kLeastBytes || limit > gpu.free_bytes)
        return Status::Error(fmt::format(
            "--device cuda: {}: cannot use {} MB; set mapping.device_memory_mb to at least {} MB "
            "and at most the free memory",
            Describe(gpu), limit / kMega, kLeastBytes / kMega));
    return std::unique_ptr<Backend>(
        std::make_unique<TESSERA_DEVICE::DevicePipeline>(gpu.name, limit));
}

}  // namespace tessera
