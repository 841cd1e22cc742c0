// SPDX-License-Identifier: Apache-2.0
#include "consensus.hpp"

#include <fmt/core.h>

#include <algorithm>

#include "armature/kinds/registration/rigid_fit.hpp"

namespace armature::registration::rigid {
namespace {

using Set = std::vector<bool>;

Eigen::Isometry3d fit(const MarkerPairs& markers, const Set& set) {
  const MarkerPairs some = only(markers, set);
  return rigid_fit(some.image, some.robot);
}

Set near(const Eigen::Isometry3d& robot_T_image, const MarkerPairs& markers, double outlier_m) {
  Set set(markers.image.size());
  for (std::size_t i = 0; i < set.size(); ++i) {
    set[i] = (robot_T_image * markers.image[i] - markers.robot[i]).norm() <= outlier_m;
  }
  return set;
}

std::ptrdiff_t size_of(const Set& set) { return std::count(set.begin(), set.end(), true); }

/// What gathers round three markers, once their number settles.
Set gathered(const MarkerPairs& markers, Set set, double outlier_m) {
  constexpr int kRounds = 10;
  for (int i = 0; i < kRounds; ++i) {
    Set next = near(fit(markers, set), markers, outlier_m);
    if (next == set || size_of(next) < 3) return next;
    set = std::move(next);
  }
  return set;
}

}  // namespace

Expected<std::vector<bool>> agreeing_markers(const MarkerPairs& markers, double outlier_m) {
  const std::size_t n = markers.image.size();
  const Set all(n, true);
  if (near(fit(markers, all), markers, outlier_m) == all) return all;
  if (n == 3) {
    return refuse(fmt::format("the three markers do not fit to within {:g} mm (outlier_mm)",
                              1e3 * outlier_m));
  }
  Set best(n, false);
  bool contested = false;
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = i + 1; j < n; ++j) {
      for (std::size_t k = j + 1; k < n; ++k) {
        Set three(n, false);
        three[i] = three[j] = three[k] = true;
        Set set = gathered(markers, std::move(three), outlier_m);
        if (set == best || size_of(set) < size_of(best)) continue;
        contested = size_of(set) == size_of(best);
        best = std::move(set);
      }
    }
  }
  // Three markers fit nearly anything: only a fourth one confirms them.
  if (size_of(best) < 4) {
    return refuse(
        fmt::format("the markers disagree: no four of {} fit to within {:g} mm "
                    "(outlier_mm)",
                    n, 1e3 * outlier_m));
  }
  if (contested) {
    return refuse(
        fmt::format("the markers disagree: two different sets of {} fit to within {:g} mm "
                    "(outlier_mm)",
                    size_of(best), 1e3 * outlier_m));
  }
  return best;
}

}  // namespace armature::registration::rigid
