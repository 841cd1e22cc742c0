// SPDX-License-Identifier: Apache-2.0
#include "armature/robot/squad.hpp"

#include <cmath>

#include "armature/robot/rotation_at.hpp"
#include "armature/robot/rotation_vector.hpp"

namespace armature {

using Eigen::Quaterniond;
using Eigen::Vector3d;

SquadPiece::Slerp::Slerp(const Quaterniond& from, const Quaterniond& to)
    : turn{double_logarithm(from.conjugate() * to)},
      axis{turn.stableNormalized()},
      half_angle{0.5 * turn.stableNorm()} {}

Quaterniond SquadPiece::Slerp::at(double x) const {
  const double cosine = std::cos(x * half_angle), sine = std::sin(x * half_angle);
  return {cosine, sine * axis.x(), sine * axis.y(), sine * axis.z()};
}

SquadPiece::SquadPiece(const Quaterniond& key, const Quaterniond& inner,
                       const Quaterniond& next_inner, const Quaterniond& next_key, double duration)
    : key_{key},
      key_R_inner_{key.conjugate() * inner},
      keys_{key, next_key},
      inners_{inner, next_inner},
      duration_{duration} {}

OrientationState SquadPiece::at(double x) const {
  // a and b are the two slerps, delta the rotation vector from a to b, k = 2 x (1 - x) the part of
  // it that is taken: r = a exp(k delta). Rates are by x until the end.
  const Quaterniond key_R_a = keys_.at(x);
  const Quaterniond a_R_b = key_R_a.conjugate() * (key_R_inner_ * inners_.at(x));
  const RotationAt at_delta = RotationAt::of(a_R_b);
  const Vector3d& delta = at_delta.vector();
  const double k = 2 * x * (1 - x), dk = 2 - 4 * x, ddk = -4;

  // How delta changes, from the turning of b in a's frame: J_l(delta) ddelta/dx = w.
  const Vector3d b_rate = a_R_b * inners_.turn;
  const Vector3d delta1 = at_delta.rate_of(b_rate - keys_.turn);
  const Vector3d dw = -keys_.turn.cross(b_rate);
  const Vector3d delta2 = at_delta.rate_of(dw - at_delta.acceleration(delta1, Vector3d::Zero()));

  const RotationAt part = at_delta.part(k);
  const Vector3d part1 = dk * delta + k * delta1;
  const Vector3d part2 = ddk * delta + 2 * dk * delta1 + k * delta2;
  const Vector3d own = part.velocity(part1);
  const Quaterniond a = key_ * key_R_a;
  const Eigen::Matrix3d base_R_a = a.toRotationMatrix();
  const double by_time = 1 / duration_;
  return {
      a * part.rotation(), by_time * (base_R_a * (keys_.turn + own)),
      by_time * by_time * (base_R_a * (keys_.turn.cross(own) + part.acceleration(part1, part2)))};
}

}  // namespace armature
