#include "synth/furniture.h"

#include <numbers>

#include "synth/paint.h"

namespace tessera {
namespace {

using Eigen::Vector3d;
constexpr double kDegree = std::numbers::pi / 180;
constexpr int kFrontChart = 2, kTopChart = 5, kBottomChart = 4;  // box charts

Eigen::Isometry3d Move(const Eigen::Isometry3d& T, double x, double y, double z) {
    return T * Eigen::Translation3d(x, y, z);
}

}  // namespace

Eigen::Isometry3d StandAt(double x, double y, double z, double yaw_deg) {
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    T.translation() = Vector3d(x, y, z);
    T.linear() = Eigen::AngleAxisd(yaw_deg * kDegree, Vector3d::UnitZ()).toRotationMatrix();
    return T;
}

int Furnisher::Box(const Eigen::Isometry3d& T, const Vector3d& bottom, const Vector3d& size,
                   const Paint& paint) {
    const Vector3d half = 0.5 * size;
    return scene_.AddShape(
        {ShapeKind::kBox, half, Move(T, bottom.x(), bottom.y(), bottom.z() + half.z())}, paint);
}

int Furnisher::Cylinder(const Eigen::Isometry3d& T, const Vector3d& bottom, double radius,
                        double height, const Paint& paint) {
    const Vector3d half(radius, radius, 0.5 * height);
    return scene_.AddShape(
        {ShapeKind::kCylinder, half, Move(T, bottom.x(), bottom.y(), bottom.z() + half.z())},
        paint);
}

int Furnisher::Sphere(const Eigen::Isometry3d& T, const Vector3d& bottom, double radius,
                      const Paint& paint) {
    return scene_.AddShape({ShapeKind::kSphere, Vector3d::Constant(radius),
                            Move(T, bottom.x(), bottom.y(), bottom.z() + radius)},
                           paint);
}

Paint Furnisher::Flat(Rgb8 colour) { return {scene_.AddTexture(PaintFlat(colour))}; }
Paint Furnisher::Fit(const ColourImage& image) {
    return {scene_.AddTexture(image, Texture::Wrap::kClamp)};
}
Paint Furnisher::Repeat(const ColourImage& image, double period_m) {
    return {scene_.AddTexture(image), period_m, period_m * image.height() / image.width()};
}

void Furnisher::Monitor(const Eigen::Isometry3d& T, const std::string& name, std::uint64_t seed) {
    scene_.BeginInstance(name, "computer");
    const Paint plastic = Repeat(PaintNoise({46, 46, 50}, 20, 128, 5), 0.1);
    Box(T, {0, 0.02, 0}, {0.24, 0.18, 0.016}, plastic);
    Box(T, {0, 0.05, 0.016}, {0.06, 0.03, 0.20}, plastic);
    const int panel = Box(T, {0, 0.015, 0.11}, {0.53, 0.035, 0.32}, plastic);
    scene_.SetPaint(panel, kFrontChart, Fit(PaintScreen(848, 512, seed)));
    scene_.BeginInstance("", "");
}

void Furnisher::Keyboard(const Eigen::Isometry3d& T, const std::string& name) {
    scene_.BeginInstance(name, "keyboard");
    const int body = Box(T, {0, 0, 0}, {0.45, 0.16, 0.022}, Flat({52, 52, 56}));
    scene_.SetPaint(body, kTopChart,
                    Fit(PaintKeyboard({52, 52, 56}, {205, 204, 198}, 900, 320, 5)));
    scene_.BeginInstance("", "");
}

void Furnisher::Laptop(const Eigen::Isometry3d& T, const std::string& name, std::uint64_t seed) {
    scene_.BeginInstance(name, "laptop");
    const Paint metal = Repeat(PaintNoise({168, 170, 176}, 18, 128, 6), 0.2);
    const int base = Box(T, {0, 0, 0}, {0.34, 0.24, 0.018}, metal);
    ColourImage deck = PaintKeyboard({168, 170, 176}, {40, 40, 44}, 680, 280, 5);
    ColourImage top(680, 480, Rgb8{168, 170, 176});
    std::copy_n(deck.data(), deck.size(), top.row(24));
    for (int y = 330; y < 450; ++y) std::fill_n(top.row(y) + 240, 200, Rgb8{140, 142, 150});
    scene_.SetPaint(base, kTopChart, Fit(top));
    Eigen::Isometry3d hinge = Move(T, 0, 0.115, 0.018);
    hinge.rotate(Eigen::AngleAxisd(-18 * kDegree, Vector3d::UnitX()));
    const int lid = Box(hinge, {0, 0, 0}, {0.34, 0.010, 0.225}, metal);
    scene_.SetPaint(lid, kFrontChart, Fit(PaintScreen(680, 450, seed)));
    scene_.BeginInstance("", "");
}

void Furnisher::Cup(const Eigen::Isometry3d& T, const std::string& name, Rgb8 base, Rgb8 band) {
    scene_.BeginInstance(name, "cup");
    const double radius = 0.041, height = 0.098;
    const Paint side = {scene_.AddTexture(PaintMug(base, band, 256)), std::numbers::pi * radius,
                        height};
    const int body = Cylinder(T, {0, 0, 0}, radius, height, side);
    scene_.SetPaint(body, 2, Fit(PaintCoffee(base, 128)));
    const Paint handle = Flat(band);
    for (const double z : {0.018, 0.068})
        Box(T, {radius + 0.012, 0, z}, {0.030, 0.013, 0.012}, handle);
    Box(T, {radius + 0.030, 0, 0.018}, {0.012, 0.013, 0.062}, handle);
    scene_.BeginInstance("", "");
}

void Furnisher::Book(const Eigen::Isometry3d& T, const std::string& name, const Vector3d& size,
                     Rgb8 colour) {
    scene_.BeginInstance(name, "book");
    const auto pixels = [](double metres) { return std::max(static_cast<int>(metres * 2000), 8); };
    const std::uint64_t seed = colour.r * 65536u + colour.g * 256u + colour.b;
    const int book =
        Box(T, {0, 0, 0}, size, Fit(PaintLeaves(pixels(size.x()), pixels(size.z()), seed)));
    scene_.SetPaint(book, kTopChart,
                    Fit(PaintBookCover(name, colour, pixels(size.x()), pixels(size.y()), seed)));
    scene_.SetPaint(book, kBottomChart, Flat(colour));
    scene_.SetPaint(book, kFrontChart,
                    Fit(PaintBookSpine(name, colour, pixels(size.x()), pixels(size.z()))));
    scene_.BeginInstance("", "");
}

void Furnisher::Lamp(const Eigen::Isometry3d& T) {
    const Paint metal = Flat({60, 92, 86});
    Cylinder(T, {0, 0, 0}, 0.075, 0.02, metal);
    Cylinder(T, {0, 0, 0.02}, 0.011, 0.36, metal);
    Sphere(T, {0, 0, 0.34}, 0.085,
           Repeat(PaintStripes({236, 214, 170}, {188, 120, 70}, 256, 12), 0.2670));
}

void Furnisher::Table(const Eigen::Isometry3d& T, const Vector3d& size, const Paint& top,
                      const std::string& name) {
    scene_.BeginInstance(name, name.empty() ? "" : "table");
    Box(T, {0, 0, size.z() - 0.035}, {size.x(), size.y(), 0.035}, top);
    for (const double x : {-1.0, 1.0})
        for (const double y : {-1.0, 1.0})
            Box(T, {x * (size.x() / 2 - 0.06), y * (size.y() / 2 - 0.06), 0},
                {0.055, 0.055, size.z() - 0.035}, top);
    scene_.BeginInstance("", "");
}

void Furnisher::Chair(const Eigen::Isometry3d& T, const std::string& name, Rgb8 colour,
                      std::uint64_t seed) {
    scene_.BeginInstance(name, "chair");
    const Paint cloth = Repeat(PaintStripes(colour, {235, 230, 215}, 256, seed), 0.25);
    const Paint wood = Repeat(PaintWood({128, 84, 50}, 1, 256, seed), 0.3);
    Box(T, {0, 0, 0.42}, {0.44, 0.44, 0.05}, cloth);
    Box(T, {0, 0.20, 0.55}, {0.44, 0.035, 0.38}, cloth);
    for (const double x : {-0.19, 0.19}) {
        Box(T, {x, -0.19, 0}, {0.04, 0.04, 0.42}, wood);
        Box(T, {x, 0.20, 0}, {0.04, 0.04, 0.55}, wood);
    }
    scene_.BeginInstance("", "");
}

void Furnisher::Shelf(const Eigen::Isometry3d& T, const std::string& name, std::uint64_t seed) {
    scene_.BeginInstance(name, "shelf");
    const Paint wood = Repeat(PaintWood({176, 132, 84}, 2, 512, seed), 0.8);
    const double width = 0.9, depth = 0.3, height = 1.8;
    for (const double x : {-width / 2, width / 2}) Box(T, {x, 0, 0}, {0.025, depth, height}, wood);
    Box(T, {0, depth / 2 - 0.01, 0}, {width, 0.02, height}, wood);
    for (int level = 0; level < 5; ++level)
        Box(T, {0, 0, 0.05 + 0.43 * level}, {width, depth, 0.025}, wood);
    const Rgb8 colours[] = {{150, 40, 44}, {40, 80, 140}, {220, 180, 70},
                            {50, 110, 70}, {90, 60, 110}, {200, 110, 50}};
    for (int level = 0; level < 4; ++level) {
        double x = -0.38;
        for (int i = 0; x < 0.30 - 0.1 * level; ++i) {
            const auto pick = static_cast<std::size_t>(seed * 7 + level * 5 + i * 3) % 6;
            const double thickness = 0.035 + 0.012 * ((i + level) % 3),
                         tall = 0.25 + 0.03 * ((i * 5 + level) % 4);
            Eigen::Isometry3d upright = Move(T, x, -0.02, 0.075 + 0.43 * level + tall / 2);
            upright.rotate(Eigen::AngleAxisd(90 * kDegree, Vector3d::UnitY()));
            Book(upright * Eigen::Translation3d(0, 0, -thickness / 2),
                 name + " book " + std::to_string(10 * level + i + 1), {tall, 0.2, thickness},
                 colours[pick]);
            x += thickness + 0.004;
        }
    }
}

void Furnisher::Poster(const Eigen::Isometry3d& T_world_wall, double x, double z, double width,
                       double height, const std::string& caption, std::uint64_t seed) {
    const int sheet =
        Box(T_world_wall, {x, -0.006, z - height / 2}, {width, 0.012, height}, Flat({70, 56, 44}));
    const auto pixels = [](double metres) { return static_cast<int>(metres * 900); };
    scene_.SetPaint(sheet, kFrontChart,
                    Fit(PaintPoster(caption, pixels(width), pixels(height), seed)));
}

void Furnisher::Door(const Eigen::Isometry3d& T_world_wall, double x, const std::string& plate,
                     Rgb8 colour) {
    const Paint frame = Flat({214, 208, 196});
    for (const double side : {-0.49, 0.49})
        Box(T_world_wall, {x + side, -0.04, 0}, {0.08, 0.08, 2.08}, frame);
    Box(T_world_wall, {x, -0.04, 2.0}, {0.9, 0.08, 0.08}, frame);
    const int leaf = Box(T_world_wall, {x, -0.01, 0}, {0.9, 0.02, 2.0}, Flat(colour));
    scene_.SetPaint(leaf, kFrontChart, Fit(PaintDoor(colour, plate, 450, 1000)));
}

void Furnisher::Shell(const Vector3d& size, const Paint& floor, const Paint& ceiling,
                      const Paint& wall) {
    constexpr double kThick = 0.1;
    const Eigen::Isometry3d T = StandAt(size.x() / 2, size.y() / 2, 0);
    const double x = size.x() / 2 + kThick / 2, y = size.y() / 2 + kThick / 2;
    const Vector3d slab(size.x() + 2 * kThick, size.y() + 2 * kThick, kThick);
    Box(T, {0, 0, -kThick}, slab, floor);
    Box(T, {0, 0, size.z()}, slab, ceiling);
    for (const double side : {-1.0, 1.0}) {
        Box(T, {side * x, 0, 0}, {kThick, size.y(), size.z()}, wall);
        Box(T, {0, side * y, 0}, {size.x() + 2 * kThick, kThick, size.z()}, wall);
    }
}

}  // namespace tessera
