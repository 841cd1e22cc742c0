// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <span>
#include <vector>

namespace armature::report::implant {

/// A place of a planned path: where the tool is turned to at the path's parameter `s`.
struct TurnSample {
  double s = 0;
  Eigen::Quaterniond rotation;
};

/// How smooth a planned turn is at its key poses: velocity and acceleration over the path's
/// parameter on both sides of a key, each from the three samples there. A cubic in the chart at the
/// key goes through them, so that a curve whose pieces are smooth shows no jump of its own.
class PlannedTurn {
 public:
  /// `keys`: places of samples. Those with fewer than three samples on a side are left out.
  PlannedTurn(std::span<const TurnSample> samples, std::span<const std::size_t> keys);

  double total_rad() const { return total_; }
  /// The largest jump at a key of the velocity, as a part of the greatest velocity of the path, or
  /// of the acceleration, as a part of the greatest acceleration: 1 or so on arcs that meet at an
  /// angle, 0.1 where the acceleration alone jumps, 0 where both go on.
  double jump_of_peak() const { return jump_; }
  /// The keys that could be looked at.
  std::size_t keys_seen() const { return seen_; }

 private:
  double total_ = 0, jump_ = 0;
  std::size_t seen_ = 0;
};

}  // namespace armature::report::implant
