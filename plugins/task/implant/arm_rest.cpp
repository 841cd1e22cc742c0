// SPDX-License-Identifier: Apache-2.0
#include "arm_rest.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <vector>

namespace armature::task::implant {
namespace {

using Eigen::Isometry3d;

constexpr Stillness kQuietest, kNoisiest{.position_m = 2e-4, .angle_rad = 1e-3};

Stillness distance(const Isometry3d& from, const Isometry3d& to) {
  const Isometry3d way = from.inverse() * to;
  return {way.translation().norm(), Eigen::AngleAxisd{way.linear()}.angle()};
}

double median(const std::deque<Stillness>& of, double Stillness::*part) {
  std::vector<double> values;
  for (const Stillness& each : of) values.push_back(each.*part);
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, middle);
  return *middle;
}

}  // namespace

bool Stillness::is_left(const Isometry3d& from, const Isometry3d& to) const {
  const Stillness way = distance(from, to);
  return way.position_m > position_m || way.angle_rad > angle_rad;
}

std::string restless(const Isometry3d& from, const Isometry3d& to) {
  const Stillness way = distance(from, to);
  return fmt::format(
      "the arm does not stand still within {:g} s: it measures its flange {:.2g} mm and {:.2g} "
      "mrad off where it was; {:g} mm and {:g} mrad of noise are allowed for at most",
      to_seconds(kRestsWithin), 1e3 * way.position_m, 1e3 * way.angle_rad,
      1e3 * kNoisiest.position_m, 1e3 * kNoisiest.angle_rad);
}

void ArmNoise::see(const Isometry3d& base_T_flange) {
  constexpr std::size_t kKept = 31;
  if (last_) {
    const Eigen::AngleAxisd turn{base_T_flange.linear() * last_->linear().transpose()};
    const Change now{base_T_flange.translation() - last_->translation(),
                     turn.angle() * turn.axis()};
    if (change_) {
      unevenness_.push_back({(now.step - change_->step).norm(), (now.turn - change_->turn).norm()});
    }
    if (unevenness_.size() > kKept) unevenness_.pop_front();
    change_ = now;
  }
  last_ = base_T_flange;
}

Stillness ArmNoise::stillness() const {
  if (unevenness_.empty()) return kQuietest;
  // Of normal noise along one axis: 4.7 times what two samples differ by, rms; along three, more.
  constexpr double kOfMedian = 4;
  const auto part = [&](double Stillness::*of) {
    return std::clamp(kOfMedian * median(unevenness_, of), kQuietest.*of, kNoisiest.*of);
  };
  return {part(&Stillness::position_m), part(&Stillness::angle_rad)};
}

}  // namespace armature::task::implant
