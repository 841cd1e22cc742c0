// SPDX-License-Identifier: Apache-2.0
#include "touching.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace armature::task::biopsy {
namespace {

using Eigen::Vector3d;

/// Of two different markers, the distance that is nearest to `distance` [m].
double nearest_distance(const std::vector<Vector3d>& markers, double distance) {
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < markers.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      const double apart = (markers[i] - markers[k]).norm();
      if (std::abs(apart - distance) < std::abs(nearest - distance)) nearest = apart;
    }
  }
  return nearest;
}

}  // namespace

Touching::Touching(const Parameters& parameters)
    : parameters_{parameters}, rest_{seconds(parameters.touch_rest), parameters.max_touch_spread} {}

void Touching::begin(std::vector<Vector3d> planned) {
  planned_ = std::move(planned);
  places_.clear();
  ++version_;
  begin_rest();
}

void Touching::begin_rest() {
  rest_.forget();
  moved_ = false;
}

void Touching::drop_last() {
  places_.pop_back();
  ++version_;
}

bool Touching::rests_anew(Time now) {
  moved_ = moved_ || rest_.moves();
  return moved_ && rest_.place(now);
}

Expected<void> Touching::take(Time now) {
  const auto place = rest_.place(now);
  if (!place) return tl::unexpected{place.error()};
  moved_ = false;
  const std::string wrong = contradiction(*place);
  if (!wrong.empty()) return refuse(wrong);
  places_.push_back(*place);
  ++version_;
  return {};
}

std::string Touching::contradiction(const Vector3d& place) const {
  for (std::size_t i = 0; i < places_.size(); ++i) {
    const double apart = (place - places_[i]).norm();
    if (apart <= parameters_.match_tolerance) {
      return fmt::format("this is touch {} again, {:.1f} mm beside it: go on to another marker",
                         i + 1, 1e3 * apart);
    }
    const double nearest = nearest_distance(planned_, apart);
    if (std::abs(nearest - apart) <= parameters_.match_tolerance) continue;
    return fmt::format(
        "this place is {:.1f} mm from touch {}, and no two markers of the plan are: "
        "{:.1f} mm comes nearest. Touch a marker, or say back and touch that one "
        "again",
        1e3 * apart, i + 1, 1e3 * nearest);
  }
  return {};
}

Expected<void> Touching::is_clear(Time now) const {
  const auto tip = rest_.place(now);
  if (!tip) return tl::unexpected{tip.error()};
  if (places_.empty()) return {};
  Vector3d middle = Vector3d::Zero();
  for (const Vector3d& place : places_) middle += place / static_cast<double>(places_.size());
  double radius = 0;
  for (const Vector3d& place : places_) radius = std::max(radius, (place - middle).norm());
  const double apart = (*tip - middle).norm(), wanted = radius + parameters_.min_touch_clearance;
  if (apart >= wanted) return {};
  return refuse(fmt::format(
      "the tip is {:.0f} mm from the middle of the touched places, {:.0f} mm are required, {:g} "
      "mm more than the farthest of them (min_touch_clearance_mm): lead it away from the head",
      1e3 * apart, 1e3 * wanted, 1e3 * parameters_.min_touch_clearance));
}

}  // namespace armature::task::biopsy
