// SPDX-License-Identifier: Apache-2.0
#include "armature/kinds/registration/handedness.hpp"

#include <fmt/core.h>

#include "armature/kinds/registration/explained_fit.hpp"
#include "armature/kinds/registration/rigid_fit.hpp"

namespace armature {
namespace {

/// The residuals of the same markers after the best motion and after the best reflection, rms [m],
/// and the largest that the error of the markers explains.
struct Fits {
  double direct_m, mirrored_m, explained_m;

  bool tell() const { return direct_m <= explained_m && mirrored_m > explained_m; }
};

Fits fits_of(const MarkerPairs& markers, double marker_error_m) {
  return {rms_of(rigid_fit(markers.image, markers.robot), markers.image, markers.robot),
          mirrored_rms(markers.image, markers.robot),
          largest_explained_fit(markers.image.size(), marker_error_m)};
}

}  // namespace

std::optional<std::string> unchecked_handedness(const MarkerPairs& markers,
                                                const Registration& found, double marker_error_m) {
  const Fits used = fits_of(only(markers, found.used), marker_error_m);
  if (used.tell()) return std::nullopt;
  const Fits all =
      fits_of(only(markers, markers_that_agree(found, marker_error_m)), marker_error_m);
  if (all.tell()) return std::nullopt;
  return fmt::format(
      "the markers do not tell whether the images are mirrored: they fit to {:.2g} mm, and their "
      "mirror image to {:.2g} mm, of which an error of {:.2g} mm a marker explains {:.2g} mm. Put "
      "a "
      "marker out of the plane of the others, or vouch for the images (handedness_vouched: true)",
      1e3 * all.direct_m, 1e3 * all.mirrored_m, 1e3 * marker_error_m, 1e3 * all.explained_m);
}

std::optional<std::string> exchangeable_handedness(const MarkerMatch& match,
                                                   double marker_error_m) {
  const double explained_m = largest_explained_fit(match.measured.size(), marker_error_m);
  if (match.mirrored_rms_m > explained_m) return std::nullopt;
  return fmt::format(
      "the markers do not tell whether the images are mirrored: exchanged, they fit their mirror "
      "image to {:.2g} mm, and an error of {:.2g} mm a marker explains {:.2g} mm. Put a marker "
      "where none is on the other side, or vouch for the images (handedness_vouched: true)",
      1e3 * match.mirrored_rms_m, 1e3 * marker_error_m, 1e3 * explained_m);
}

}  // namespace armature
