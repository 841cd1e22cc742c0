// SPDX-License-Identifier: Apache-2.0
#include "jaw_place.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace armature::task::implant {
namespace {

using Eigen::Isometry3d;

constexpr int kJawSamples = 10;  // one by itself errs too much far from the body

}  // namespace

void JawPlace::locate(std::vector<Eigen::Vector3d> ends) {
  ends_ = std::move(ends);
  average_.clear();
  now_.clear();
  first_.reset();
}

double JawPlace::max_moved(const Isometry3d& tracker_T_jaw, const Isometry3d& from) const {
  double max_m = 0;
  for (const Eigen::Vector3d& end : ends_) {
    max_m = std::max(max_m, (tracker_T_jaw * end - from * end).norm());
  }
  return max_m;
}

std::optional<std::string> JawPlace::see(const Isometry3d& tracker_T_jaw) {
  average_.add(tracker_T_jaw);
  now_.add(tracker_T_jaw);
  if (now_.count() < std::clamp(parameters_.jaw_samples / 2, 1, kJawSamples)) {
    if (located()) now_.clear();
    return std::nullopt;
  }
  const Isometry3d now = now_.mean();
  now_.clear();
  if (!first_) first_ = now;
  const double moved_m = max_moved(now, *first_);
  if (moved_m <= parameters_.max_jaw_motion) return std::nullopt;
  return fmt::format("the jaw moved by {:.2f} mm while its place was averaged, {:g} mm are allowed",
                     1e3 * moved_m, 1e3 * parameters_.max_jaw_motion);
}

std::optional<std::string> JawPlace::guard(const Isometry3d& tracker_T_jaw) {
  now_.add(tracker_T_jaw);
  if (now_.count() < kJawSamples) return std::nullopt;
  const double moved_m = max_moved(now_.mean(), average_.mean());
  now_.clear();
  if (moved_m <= parameters_.max_jaw_motion) return std::nullopt;
  return fmt::format("the jaw has moved by {:.2f} mm, {:g} mm are allowed", 1e3 * moved_m,
                     1e3 * parameters_.max_jaw_motion);
}

}  // namespace armature::task::implant
