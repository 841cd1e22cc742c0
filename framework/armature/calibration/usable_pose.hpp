// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <numbers>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace armature ARMATURE_EXPORT {

/// What reasons are told in.
constexpr double degrees(double rad) { return rad * 180 / std::numbers::pi; }
constexpr double millimetres(double m) { return m * 1e3; }

/// What makes `pose` no rotation and position, to be read behind its name ("is not finite"), or
/// nullopt.
std::optional<std::string> wrong_with(const Eigen::Isometry3d& pose);

/// That the records of two poses, told by index, are the same to the last bit: measured twice they
/// would differ, and counted twice they would promise too much.
std::string said_twice(std::size_t first, std::size_t second);

/// How far orientations turn about their three axes, rms about their mean [rad], largest first;
/// from rotation vectors seen from the first pose, so that turns about one axis are exactly that.
Eigen::Vector3d spread_of(std::span<const Eigen::Isometry3d> poses);

}  // namespace armature
