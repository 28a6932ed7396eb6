#include "synth/simulated_detector.h"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>

#include "synth/hash_random.h"

namespace tessera {
namespace {

constexpr std::uint64_t kDetectorStream = 5;
constexpr double kProbability = 0.9, kProbabilityStd = 0.06;
constexpr double kLeastShare = 400.0 / (640.0 * 480.0);  // of the image area

// Returns a class other than `right` and 0.
int WrongClass(const Scene& scene, int right, std::uint64_t bits) {
    const int count = static_cast<int>(scene.class_names().size()) - 1;
    const int step = 1 + static_cast<int>(UniformFromBits(bits) * (count - 1));
    return 1 + (right - 1 + step) % count;
}

}  // namespace

std::vector<InstanceBox> FindInstanceBoxes(const Image<std::uint16_t>& instance,
                                           std::size_t instance_count) {
    const int width = instance.width(), height = instance.height();
    std::vector<InstanceBox> boxes(instance_count, InstanceBox{width, height, -1, -1, 0});
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            InstanceBox& box = boxes[instance(x, y)];
            box.x_min = std::min(box.x_min, x);
            box.y_min = std::min(box.y_min, y);
            box.x_max = std::max(box.x_max, x);
            box.y_max = std::max(box.y_max, y);
            ++box.pixels;
        }
    }
    return boxes;
}

Image<std::uint16_t> CastInstances(const Scene& scene, const PinholeCamera& camera,
                                   const Eigen::Isometry3d& T_world_camera, double time_s) {
    const std::unique_ptr<ViewCaster> view = scene.View(camera, T_world_camera, time_s);
    Image<std::uint16_t> instance(camera.width, camera.height);
    constexpr int kRows = 16;
    tbb::parallel_for(0, (camera.height + kRows - 1) / kRows, [&](int band) {
        const PixelRect rect{0, band * kRows, camera.width,
                             std::min(camera.height, (band + 1) * kRows)};
        std::vector<SurfaceHit> hits(static_cast<std::size_t>(rect.width()) *
                                     static_cast<std::size_t>(rect.height()));
        view->Cast(rect, 0, 0, hits);
        std::ranges::transform(hits, instance.row(rect.y_begin), [&](const SurfaceHit& hit) {
            return static_cast<std::uint16_t>(hit.valid() ? scene.InstanceOf(hit) : 0);
        });
    });
    return instance;
}

std::vector<SimulatedDetection> SimulateDetections(const Scene& scene,
                                                   const std::vector<InstanceBox>& boxes,
                                                   std::size_t image_pixels, std::uint64_t seed,
                                                   std::int64_t frame,
                                                   const DetectorMistakes& mistakes) {
    std::vector<SimulatedDetection> detections;
    const double least = kLeastShare * static_cast<double>(image_pixels);
    for (std::size_t i = 1; i < boxes.size(); ++i) {
        if (static_cast<double>(boxes[i].pixels) <= least) continue;
        std::uint64_t counter =
            StreamKey(seed, kDetectorStream, static_cast<std::uint64_t>(frame)) + 4 * i;
        if (UniformFromBits(MixBits(counter++)) < mistakes.missed) continue;
        int class_id = scene.instances()[i].class_id;
        const bool wrong = UniformFromBits(MixBits(counter++)) < mistakes.wrong_class &&
                           scene.class_names().size() > 2;
        if (wrong) class_id = WrongClass(scene, class_id, MixBits(counter));
        ++counter;
        const double p = std::clamp(
            kProbability + kProbabilityStd * GaussianFromBits(MixBits(counter)), 0.05, 0.999);
        detections.push_back({static_cast<int>(i), class_id, p, boxes[i]});
    }
    return detections;
}

}  // namespace tessera
