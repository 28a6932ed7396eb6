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
// An empty map, one frame and the storage of passing use.
constexpr std::size_t kLeastBytes = 64 * kMega;

std::string Describe(const Gpu& gpu) {
    return fmt::format("{}, compute capability {}.{}, {} of {} MB free", gpu.name, gpu.major,
                       gpu.minor, gpu.free_bytes / kMega, gpu.total_bytes / kMega);
}

}  // namespace

std::string DescribeGpus() {
    const char* reason = nullptr;
    const int count = CountGpus(reason);
    if (count == 0) return fmt::format("built in, no GPU: {}", reason);
    Gpu gpu;
    std::string text = UseGpu(0, gpu, reason) ? Describe(gpu) : reason;
    if (count > 1) text += fmt::format("; {} more", count - 1);
    return text + " (by --device cuda only, and never yet tried on one)";
}

Result<std::unique_ptr<Device>> OpenGpu(const DeviceConfig& config) {
    const char* reason = nullptr;
    Gpu gpu;
    if (CountGpus(reason) == 0 || !UseGpu(0, gpu, reason))
        return Status::Error(fmt::format(
            "--device cuda: no GPU: {}; leave --device out to run on the processor", reason));
    if (gpu.major < kLeastMajor || (gpu.major == kLeastMajor && gpu.minor < kLeastMinor))
        return Status::Error(fmt::format(
            "--device cuda: {}: needs compute capability {}.{}; leave --device out to run on the "
            "processor",
            Describe(gpu), kLeastMajor, kLeastMinor));
    const std::size_t limit = config.memory_mb > 0
                                  ? static_cast<std::size_t>(config.memory_mb) * kMega
                                  : gpu.free_bytes / 10 * 9;
    if (limit < kLeastBytes || limit > gpu.free_bytes)
        return Status::Error(fmt::format(
            "--device cuda: {}: {} MB wanted, at least {} MB needed (mapping.device_memory_mb)",
            Describe(gpu), limit / kMega, kLeastBytes / kMega));
    return std::unique_ptr<Device>(
        std::make_unique<TESSERA_DEVICE::DevicePipeline>(gpu.name, limit));
}

}  // namespace tessera
