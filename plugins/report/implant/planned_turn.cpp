// SPDX-License-Identifier: Apache-2.0
#include "planned_turn.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <optional>

#include "armature/robot/geometry/rotation_vector.hpp"

namespace armature::report::implant {
namespace {

using Eigen::Vector3d;

constexpr std::size_t kOnASide = 3;  // samples

struct Rates {
  Vector3d velocity, acceleration;  // over s
};

/// On one side of sample `at`: `step` is 1 for the samples behind it, -1 for those before.
std::optional<Rates> rates_beside(std::span<const TurnSample> samples, std::size_t at, int step) {
  const auto place = static_cast<std::ptrdiff_t>(at);
  const std::ptrdiff_t last = place + step * static_cast<std::ptrdiff_t>(kOnASide);
  if (last < 0 || last >= static_cast<std::ptrdiff_t>(samples.size())) return std::nullopt;
  Eigen::Matrix3d powers, turns;
  for (std::size_t i = 0; i < kOnASide; ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    const TurnSample& sample =
        samples[static_cast<std::size_t>(place + step * (static_cast<std::ptrdiff_t>(i) + 1))];
    const double ds = sample.s - samples[at].s;
    if (ds * step <= 0) return std::nullopt;  // the segment has ended
    powers.row(row) << ds, ds * ds, ds * ds * ds;
    turns.row(row) = rotation_vector_of(samples[at].rotation.conjugate() * sample.rotation);
  }
  const Eigen::Matrix3d coefficients = powers.partialPivLu().solve(turns);
  return Rates{coefficients.row(0), 2 * coefficients.row(1)};
}

/// What is below `noise` is rounding, and has no parts.
double part_of(double jump, double peak, double noise) { return peak > noise ? jump / peak : 0; }

}  // namespace

PlannedTurn::PlannedTurn(std::span<const TurnSample> samples, std::span<const std::size_t> keys) {
  double peak_velocity = 0, peak_acceleration = 0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (i > 0) {
      total_ +=
          rotation_vector_of(samples[i - 1].rotation.conjugate() * samples[i].rotation).norm();
    }
    if (const auto rates = rates_beside(samples, i, 1)) {
      peak_velocity = std::max(peak_velocity, rates->velocity.norm());
      peak_acceleration = std::max(peak_acceleration, rates->acceleration.norm());
    }
  }
  for (const std::size_t key : keys) {
    const auto before = rates_beside(samples, key, -1), behind = rates_beside(samples, key, 1);
    if (!before || !behind) continue;
    ++seen_;
    constexpr double kNoise = 1e-6;  // of the acceleration, as a part of the velocity
    jump_ =
        std::max({jump_, part_of((behind->velocity - before->velocity).norm(), peak_velocity, 0),
                  part_of((behind->acceleration - before->acceleration).norm(), peak_acceleration,
                          kNoise * peak_velocity)});
  }
}

}  // namespace armature::report::implant
