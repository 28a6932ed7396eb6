// Furniture for the built-in scenes. Each piece is placed by its foot frame: origin at the centre
// of the bottom, z up, front towards -y. Owner thread only, while the scene is being built.
#pragma once

#include <cstdint>
#include <string>

#include "synth/analytic_scene.h"

namespace tessera {

// An upright pose at (x, y, z) metres, rotated by `yaw_deg` about the vertical axis.
Eigen::Isometry3d StandAt(double x, double y, double z, double yaw_deg = 0);

class Furnisher {
  public:
    explicit Furnisher(AnalyticScene& scene) : scene_(scene) {}

    // Bodies, placed by the centre of their bottom in the frame T_world_foot; sizes in metres.
    // Return the part's number.
    int Box(const Eigen::Isometry3d& T_world_foot, const Eigen::Vector3d& bottom,
            const Eigen::Vector3d& size, const Paint& paint);
    int Cylinder(const Eigen::Isometry3d& T_world_foot, const Eigen::Vector3d& bottom,
                 double radius, double height, const Paint& paint);
    int Sphere(const Eigen::Isometry3d& T_world_foot, const Eigen::Vector3d& bottom, double radius,
               const Paint& paint);
    // Flat and Fit stretch over a face; Repeat repeats every `period_m`.
    Paint Flat(Rgb8 colour);
    Paint Fit(const ColourImage& image);
    Paint Repeat(const ColourImage& image, double period_m);

    void Monitor(const Eigen::Isometry3d& T, const std::string& name, std::uint64_t seed);
    void Keyboard(const Eigen::Isometry3d& T, const std::string& name);
    void Laptop(const Eigen::Isometry3d& T, const std::string& name, std::uint64_t seed);
    void Cup(const Eigen::Isometry3d& T, const std::string& name, Rgb8 base, Rgb8 band);
    // Lies on its back cover; size is width, depth, thickness.
    void Book(const Eigen::Isometry3d& T, const std::string& name, const Eigen::Vector3d& size,
              Rgb8 colour);
    void Lamp(const Eigen::Isometry3d& T);
    void Table(const Eigen::Isometry3d& T, const Eigen::Vector3d& size, const Paint& top,
               const std::string& name);
    void Chair(const Eigen::Isometry3d& T, const std::string& name, Rgb8 colour,
               std::uint64_t seed);
    void Shelf(const Eigen::Isometry3d& T, const std::string& name, std::uint64_t seed);
    // Flat objects on a wall, centred at (x, z). In the wall's frame the wall surface is y = 0 and
    // the room lies towards -y.
    void Poster(const Eigen::Isometry3d& T_world_wall, double x, double z, double width,
                double height, const std::string& caption, std::uint64_t seed);
    void Door(const Eigen::Isometry3d& T_world_wall, double x, const std::string& plate,
              Rgb8 colour);

    // Floor, ceiling and four walls around x in [0, size.x], y in [0, size.y], z in [0, size.z],
    // metres.
    void Shell(const Eigen::Vector3d& size, const Paint& floor, const Paint& ceiling,
               const Paint& wall);

  private:
    AnalyticScene& scene_;
};

}  // namespace tessera
