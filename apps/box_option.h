// The option --box of several commands.
#pragma once

#include <CLI/CLI.hpp>
#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <vector>

#include "core/status.h"

namespace tessera {

inline void AddBoxOption(CLI::App& command, std::vector<double>& box, const std::string& what) {
    command.add_option("--box", box, what + ": lowest x y z, highest x y z, metres")
        ->type_name("M")
        ->expected(6);
}

// Of six numbers or none.
inline Result<std::optional<Eigen::AlignedBox3d>> BoxOf(const std::vector<double>& box) {
    if (box.empty()) return std::optional<Eigen::AlignedBox3d>();
    const Eigen::Vector3d low(box[0], box[1], box[2]), high(box[3], box[4], box[5]);
    if (!(low.array() < high.array()).all())
        return Status::Error(
            "--box: give the lowest x y z first, then the highest, each larger than the lowest");
    return std::optional(Eigen::AlignedBox3d(low, high));
}

}  // namespace tessera
