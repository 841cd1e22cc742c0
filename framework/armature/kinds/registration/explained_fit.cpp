// SPDX-License-Identifier: Apache-2.0
#include "armature/kinds/registration/explained_fit.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "armature/kinds/registration/rigid_fit.hpp"

namespace armature {

double largest_explained_fit(std::size_t markers, double marker_error_m) {
  constexpr double kNormal = 4.753424308822899;  // all but one of a million of a standard normal
  if (markers < 3) return std::numeric_limits<double>::infinity();
  const double n = static_cast<double>(markers), freedom = 3 * n - 6;
  const double ninth = 2 / (9 * freedom);
  const double chi_squared = freedom * std::pow(1 - ninth + kNormal * std::sqrt(ninth), 3);
  return marker_error_m * std::sqrt(chi_squared / (3 * n));
}

double shown_marker_error(const MarkerPairs& markers, double marker_error_m) {
  const std::size_t n = markers.image.size();
  if (n < 3) return marker_error_m;
  const double fit_m =
      rms_of(rigid_fit(markers.image, markers.robot), markers.image, markers.robot);
  return std::max(marker_error_m, fit_m / std::sqrt(1 - 2 / static_cast<double>(n)));
}

std::vector<bool> markers_that_agree(const Registration& found, double marker_error_m) {
  constexpr double kErrors = 6;
  std::vector<bool> set = found.used;
  for (std::size_t i = 0; i < set.size(); ++i) {
    if (found.residual_m[i] <= kErrors * marker_error_m) set[i] = true;
  }
  return set;
}

std::optional<std::string> unexplained_fit(const MarkerPairs& markers, const Registration& found,
                                           double marker_error_m) {
  const MarkerPairs used = only(markers, found.used);
  const double limit_m = largest_explained_fit(used.image.size(), marker_error_m);
  const double best_m = rms_of(rigid_fit(used.image, used.robot), used.image, used.robot);
  const double fit_m = std::min(found.fre_m, best_m);
  if (fit_m <= limit_m) return std::nullopt;
  return fmt::format(
      "the markers fit to {:.2g} mm, which an error of {:.2g} mm a marker does not explain "
      "(at most {:.2g} mm, 99.9999 %): state the error that they have (marker_error), or look for "
      "a marker that has moved",
      1e3 * fit_m, 1e3 * marker_error_m, 1e3 * limit_m);
}

}  // namespace armature
