// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "armature/kinds/made_for_robot.hpp"
#include "armature/values/expected.hpp"

namespace armature ARMATURE_EXPORT {

/// The same markers in two frames: marker i of one is marker i of the other. [m]
struct MarkerPairs {
  std::vector<Eigen::Vector3d> image;  // where the images show them
  std::vector<Eigen::Vector3d> robot;  // where the arm or a tracker found them, in the base frame
};

/// How the image lies before the robot, and how well the markers say so.
struct Registration {
  Eigen::Affine3d robot_T_image = Eigen::Affine3d::Identity();
  /// What decided: a method may need three markers only, or leave out one that disagrees.
  std::vector<bool> used;
  std::vector<double> residual_m;  // by which the map misses each marker, used or not
  double fre_m = 0;                // fiducial registration error: rms of those used
  /// How badly the markers are placed for the method: 1 at best, infinite when they are useless.
  double condition = 1;
};

/// Finds the map from an image's frame to the robot's from markers seen in both. Pure; may
/// allocate.
class Registrar {
 public:
  static constexpr std::string_view kKind = "registration";
  using Factory = MadeFromParams<Registrar>;

  virtual ~Registrar() = default;
  /// Refuses markers that do not determine the map, or contradict each other, with a reason that
  /// names them, counted from 1.
  virtual Expected<Registration> find(const MarkerPairs& markers) const = 0;
};

/// What makes it impossible to register at all, or nullopt: not the same number of markers in both
/// frames, fewer than `least`, a number that is not finite. The first line of every registrar.
std::optional<std::string> invalid_input(const MarkerPairs& markers, std::size_t least);

/// Those of `markers` that are `used`.
MarkerPairs only(const MarkerPairs& markers, const std::vector<bool>& used);

/// Of a found map with its `used` markers: their residuals and the fiducial registration error.
void measure_residuals(const MarkerPairs& markers, Registration& found);

/// How nearly on one line markers are: the largest over the second largest singular value of what
/// is left of them about their centroid. A rotation is determined by anything but a line.
double condition_of_line(const std::vector<Eigen::Vector3d>& markers);

}  // namespace armature
