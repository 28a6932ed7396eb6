#include "render/mesh_picture.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/check.h"
#include "render/path_overlay.h"
#include "render/triangle_scene.h"

namespace tessera {
namespace {

using Eigen::Vector3f;
using Shading = RenderStyle::Shading;

Vector3f ToVector(const Rgb8& c) { return Vector3f(c.r, c.g, c.b); }

Rgb8 ToRgb(const Vector3f& c) {
    const auto byte = [](float x) {
        return static_cast<std::uint8_t>(std::lround(std::clamp(x, 0.0f, 255.0f)));
    };
    return {byte(c.x()), byte(c.y()), byte(c.z())};
}

// The texture's colour, 0..255, bilinear; (0, 0) is its top-left corner.
Vector3f Sample(const ColourImage& texture, const Eigen::Vector2f& uv) {
    const float u = std::clamp(uv.x() * static_cast<float>(texture.width()) - 0.5f, 0.0f,
                               static_cast<float>(texture.width() - 1));
    const float v = std::clamp(uv.y() * static_cast<float>(texture.height()) - 0.5f, 0.0f,
                               static_cast<float>(texture.height() - 1));
    const int x = static_cast<int>(u), y = static_cast<int>(v);
    const int right = std::min(x + 1, texture.width() - 1),
              below = std::min(y + 1, texture.height() - 1);
    const float fx = u - static_cast<float>(x), fy = v - static_cast<float>(y);
    return (1 - fy) * ((1 - fx) * ToVector(texture(x, y)) + fx * ToVector(texture(right, y))) +
           fy * ((1 - fx) * ToVector(texture(x, below)) + fx * ToVector(texture(right, below)));
}

// Shades a ray's hit on the mesh. Colours are 0..255.
class Shader {
  public:
    // `model` is null for a mesh without a texture.
    Shader(const TriangleMesh& mesh, const TexturedMesh* model, Shading shading)
        : mesh_(mesh), model_(model), shading_(shading) {
        const bool wants_colours = shading == Shading::kColour || shading == Shading::kLitColour;
        if (mesh.colours.empty() && model == nullptr && wants_colours) shading_ = Shading::kShaded;
    }

    Vector3f operator()(const RayHit& hit, const Vector3f& direction) const {
        const auto& corners = mesh_.triangles[hit.triangle];
        const Weights weights = {1 - hit.u - hit.v, hit.u, hit.v};
        if (shading_ == Shading::kColour) return Colour(corners, weights);
        const Vector3f normal = Normal(corners, weights);
        if (shading_ == Shading::kNormal) return 127.5f * (normal + Vector3f::Ones());
        const float facing = std::abs(normal.dot(direction)) / direction.norm();
        if (shading_ == Shading::kLitColour)
            return (0.5f + 0.5f * facing) * Colour(corners, weights);
        return (0.22f + 0.78f * facing) * Vector3f(222, 220, 214);
    }

  private:
    using Corners = std::array<std::uint32_t, 3>;
    using Weights = std::array<float, 3>;

    Vector3f Colour(const Corners& corners, const Weights& weights) const {
        if (model_ != nullptr) {
            Eigen::Vector2f uv = Eigen::Vector2f::Zero();
            for (std::size_t i = 0; i < 3; ++i) uv += weights[i] * model_->uv[corners[i]];
            return Sample(model_->texture, uv);
        }
        Vector3f colour = Vector3f::Zero();
        for (std::size_t i = 0; i < 3; ++i)
            colour += weights[i] * ToVector(mesh_.colours[corners[i]]);
        return colour;
    }

    Vector3f Normal(const Corners& corners, const Weights& weights) const {
        Vector3f normal = Vector3f::Zero();
        if (!mesh_.normals.empty())
            for (std::size_t i = 0; i < 3; ++i) normal += weights[i] * mesh_.normals[corners[i]];
        if (normal.squaredNorm() < 1e-12f) {
            const Vector3f& a = mesh_.vertices[corners[0]];
            normal = (mesh_.vertices[corners[1]] - a).cross(mesh_.vertices[corners[2]] - a);
        }
        return normal.normalized();
    }

    const TriangleMesh& mesh_;
    const TexturedMesh* model_;
    Shading shading_;
};

// Positions of the four samples of a pixel, relative to its centre.
constexpr double kSamples[4][2] = {{-0.25, -0.25}, {0.25, -0.25}, {-0.25, 0.25}, {0.25, 0.25}};

ColourImage Render(const TriangleMesh& mesh, const TexturedMesh* model, const PinholeCamera& camera,
                   const Eigen::Isometry3d& T_world_camera, const RenderStyle& style) {
    TESSERA_CHECK(camera.width > 0 && camera.height > 0, "{} x {}", camera.width, camera.height);
    const TriangleScene scene(mesh);
    const Shader shade(mesh, model, style.shading);
    const Vector3f origin = T_world_camera.translation().cast<float>();
    ColourImage image(camera.width, camera.height);
    const auto render_row = [&](int y) {
        const float down =
            static_cast<float>(y) / static_cast<float>(std::max(camera.height - 1, 1));
        const Vector3f background =
            (1 - down) * ToVector(style.background_top) + down * ToVector(style.background_bottom);
        for (int x = 0; x < camera.width; ++x) {
            std::array<Vector3f, 4> directions;
            for (std::size_t i = 0; i < 4; ++i) {
                const Eigen::Vector3d ray =
                    camera.Unproject(x + kSamples[i][0], y + kSamples[i][1], 1);
                directions[i] = (T_world_camera.linear() * ray).cast<float>();
            }
            const auto hits = scene.CastFour(origin, directions, style.cull_back_faces);
            Vector3f sum = Vector3f::Zero();
            for (std::size_t i = 0; i < 4; ++i)
                sum += hits[i].hit() ? shade(hits[i], directions[i]) : background;
            image(x, y) = ToRgb(0.25f * sum);
        }
    };
    tbb::parallel_for(tbb::blocked_range<int>(0, camera.height, 8), [&](const auto& rows) {
        for (int y = rows.begin(); y != rows.end(); ++y) render_row(y);
    });
    DrawPath(camera, T_world_camera, style, image);
    DrawBoxes(camera, T_world_camera, style, image);
    return image;
}

}  // namespace

ColourImage RenderMesh(const TriangleMesh& mesh, const PinholeCamera& camera,
                       const Eigen::Isometry3d& T_world_camera, const RenderStyle& style) {
    return Render(mesh, nullptr, camera, T_world_camera, style);
}

ColourImage RenderTextured(const TexturedMesh& model, const PinholeCamera& camera,
                           const Eigen::Isometry3d& T_world_camera, const RenderStyle& style) {
    return Render(model.mesh, &model, camera, T_world_camera, style);
}

}  // namespace tessera
