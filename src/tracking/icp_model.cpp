#include "tracking/icp_model.h"

#include <tbb/parallel_for.h>

#include "tracking/model_kernels.h"
#include "tracking/set_view.h"

namespace tessera {
namespace {

ModelImages ImagesOf(const DepthImage& depth_m, const Image<Eigen::Vector3f>& normal,
                     const Image<float>& intensity) {
    return {depth_m.data(), normal.data()->data(), intensity.data(), depth_m.width(),
            depth_m.height()};
}

void TakeView(const PredictedView& view, float jump_m, IcpModelLevel& level) {
    level.camera = view.camera;
    level.depth_m = view.depth_m;
    level.normal_camera = view.normal_camera;
    const int width = view.camera.width, height = view.camera.height;
    level.intensity.Resize(width, height);
    const ModelImages images = ImagesOf(view.depth_m, view.normal_camera, view.intensity);
    tbb::parallel_for(0, height, [&](int y) {
        for (int x = 0; x < width; ++x)
            level.intensity(x, y) = images.TrustedIntensity(x, y, jump_m);
    });
}

void Halve(const IcpModelLevel& fine, float jump_m, IcpModelLevel& coarse) {
    const PinholeCamera c = coarse.camera = HalfOf(fine.camera);
    coarse.depth_m.Resize(c.width, c.height);
    coarse.normal_camera.Resize(c.width, c.height);
    coarse.intensity.Resize(c.width, c.height);
    const ModelImages images = ImagesOf(fine.depth_m, fine.normal_camera, fine.intensity);
    tbb::parallel_for(0, c.height, [&](int y) {
        for (int x = 0; x < c.width; ++x) {
            const ModelPixel pixel = images.Halved(x, y, jump_m);
            coarse.depth_m(x, y) = pixel.depth_m;
            coarse.normal_camera(x, y) =
                Eigen::Vector3f(pixel.normal[0], pixel.normal[1], pixel.normal[2]);
            coarse.intensity(x, y) = pixel.intensity;
        }
    });
}

}  // namespace

PinholeCamera HalfOf(const PinholeCamera& fine) {
    return {fine.width / 2, fine.height / 2,     fine.fx / 2,
            fine.fy / 2,    (fine.cx - 0.5) / 2, (fine.cy - 0.5) / 2};
}

void BuildIcpModel(const PredictedView& view, int count, float jump_m,
                   std::vector<IcpModelLevel>& levels) {
    levels.resize(static_cast<std::size_t>(count));
    TakeView(view, jump_m, levels[0]);
    for (std::size_t i = 1; i < levels.size(); ++i) Halve(levels[i - 1], jump_m, levels[i]);
}

void SetModel(const IcpModelLevel& model, IcpArguments& a) {
    SetCamera(model.camera, a);
    a.depth = model.depth_m.data();
    a.normal = model.normal_camera.empty() ? nullptr : model.normal_camera.data()->data();
    a.intensity = model.intensity.data();
}

}  // namespace tessera
