// SPDX-License-Identifier: Apache-2.0
#include "armature/robot/squad.hpp"

#include "armature/robot/rotation_vector.hpp"

namespace armature {

SquadPiece::SquadPiece(const Eigen::Quaterniond& key, const Eigen::Quaterniond& inner,
                       const Eigen::Quaterniond& next_inner, const Eigen::Quaterniond& next_key,
                       double duration)
    : key_{key},
      inner_{inner},
      turn_{double_logarithm(key.conjugate() * next_key)},
      inner_turn_{double_logarithm(inner.conjugate() * next_inner)},
      duration_{duration} {}

OrientationState SquadPiece::at(double x) const {
  // a and b are the two slerps, delta the rotation vector from a to b, k = 2 x (1 - x) the part of
  // it that is taken: r = a exp(k delta). Rates are by x until the end.
  const Eigen::Quaterniond a = key_ * rotation_of(x * turn_);
  const Eigen::Quaterniond b = inner_ * rotation_of(x * inner_turn_);
  const Eigen::Quaterniond a_R_b = a.conjugate() * b;
  const Eigen::Vector3d delta = double_logarithm(a_R_b);
  const double k = 2 * x * (1 - x), dk = 2 - 4 * x, ddk = -4;

  // How delta changes, from the turning of b in a's frame: J_l(delta) ddelta/dx = w.
  const Eigen::Vector3d b_rate = a_R_b * inner_turn_;
  const Eigen::Vector3d w = b_rate - turn_;
  const RotationAt at_delta{delta, a_R_b};
  const Eigen::Vector3d delta1 = at_delta.rate_of(w);
  const Eigen::Vector3d dw = -turn_.cross(b_rate);
  const Eigen::Vector3d no_change = Eigen::Vector3d::Zero();
  const Eigen::Vector3d delta2 = at_delta.rate_of(dw - at_delta.acceleration(delta1, no_change));

  const RotationAt part{k * delta};
  const Eigen::Vector3d part1 = dk * delta + k * delta1;
  const Eigen::Vector3d part2 = ddk * delta + 2 * dk * delta1 + k * delta2;
  const Eigen::Vector3d own = part.velocity(part1);
  return {a * part.rotation(), a * (turn_ + own) / duration_,
          a * (turn_.cross(own) + part.acceleration(part1, part2)) / (duration_ * duration_)};
}

}  // namespace armature
