// A window that shows a wall, for measuring it with the mouse.
#pragma once

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "support/temp_folder.h"
#include "viz/measuring.h"
#include "viz/model_window.h"

namespace tessera::testing_support {

inline constexpr Rgb8 kGreen{20, 220, 20}, kRed{220, 20, 20};

inline void AddSquare(TriangleMesh& mesh, const std::array<Eigen::Vector3f, 4>& corners,
                      Rgb8 colour) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (const Eigen::Vector3f& corner : corners) {
        mesh.vertices.push_back(corner);
        mesh.colours.push_back(colour);
    }
    mesh.triangles.push_back({first, first + 3, first + 1});
    mesh.triangles.push_back({first + 1, first + 3, first + 2});
}

// The measuring tool's window, on a wall.
class MeasureWindow : public ModelWindow {
  protected:
    // A wall: a green square of 2 m, facing the camera at the origin.
    void SetUp() override {
        ModelWindow::SetUp();
        if (!display_) return;
        AddSquare(model_.mesh, {{{-1, -1, 3}, {1, -1, 3}, {1, 1, 3}, {-1, 1, 3}}}, kGreen);
        model_.path.push_back(Eigen::Isometry3d::Identity());
    }
    void Open() {
        options_.measurements = file_;
        options_.output_folder = folder_.path();
        options_.message_s = 1e3;  // works on slow machines too
        ModelWindow::Open(model_);
    }
    static bool Like(const Rgb8& c, const Rgb8& colour) {
        const int high = colour.g > colour.r ? c.g : c.r, low = colour.g > colour.r ? c.r : c.g;
        return high > 60 && high > 2 * low && high > 2 * c.b;
    }
    // The pixels of that colour in the 3D view.
    std::vector<Eigen::Vector2i> Pixels(Rgb8 colour) {
        const ColourImage picture = viewer_->Picture();
        std::vector<Eigen::Vector2i> pixels;
        for (int y = 0; y < picture.height(); ++y)
            for (int x = 0; x < picture.width(); ++x)
                if (Like(picture(x, y), colour)) pixels.emplace_back(x, y);
        return pixels;
    }
    double Count(Rgb8 colour) { return static_cast<double>(Pixels(colour).size()); }
    // The pixel of the square that lies farthest in a direction of the picture: its corner.
    Eigen::Vector2i Corner(const std::vector<Eigen::Vector2i>& pixels, int x, int y) const {
        return *std::ranges::max_element(
            pixels, {}, [=](const Eigen::Vector2i& p) { return x * p.x() + y * p.y(); });
    }
    void ClickAt(const Eigen::Vector2i& at) {
        display_->MoveTo(static_cast<float>(at.x()), static_cast<float>(at.y()));
        Rounds(3);
        display_->Press(1);
        Rounds(2);
        display_->Release(1);
        Rounds(4);
    }
    std::vector<Measurement> Saved() const {
        const Result<std::vector<Measurement>> read = ReadMeasurements(file_);
        return read.ok() ? read.value() : std::vector<Measurement>();
    }

    TempFolder folder_;
    const std::string file_ = folder_.path() + "/measurements.json";
    ViewedModel model_;
};

}  // namespace tessera::testing_support
