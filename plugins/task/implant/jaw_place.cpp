// SPDX-License-Identifier: Apache-2.0
#include "jaw_place.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
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

double JawPlace::max_scatter() const {
  double max_m = 0;
  for (const Eigen::Vector3d& end : ends_) {
    max_m = std::max(max_m, average_.error_at(end).rms_m * std::sqrt(average_.count()));
  }
  return max_m;
}

std::optional<std::string> JawPlace::see(const Isometry3d& tracker_T_jaw) {
  average_.add(tracker_T_jaw);
  now_.add(tracker_T_jaw);
  // Of a jaw that jumps to and fro, means of several samples are alike, and no place of it.
  const double scatter_m = located() ? max_scatter() : 0;
  if (scatter_m > parameters_.max_jaw_motion) {
    return fmt::format(
        "the samples of the jaw scatter by {:.2f} mm (rms) while its place is averaged, {:g} mm "
        "are allowed",
        1e3 * scatter_m, 1e3 * parameters_.max_jaw_motion);
  }
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
