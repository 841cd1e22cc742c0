// SPDX-License-Identifier: Apache-2.0
#include "rigid.hpp"

#include <fmt/core.h>

#include "armature/kinds/registration/rigid_fit.hpp"
#include "armature/runtime/plugins/plugin.hpp"
#include "consensus.hpp"

namespace armature::registration::rigid {
namespace {

/// A reflection fits clearly better than any motion.
bool is_mirrored(const MarkerPairs& markers) {
  constexpr double kClearly = 0.2, kTenthOfAMillimetre = 1e-4;
  const double rms = rms_of(rigid_fit(markers.image, markers.robot), markers.image, markers.robot);
  return rms > kTenthOfAMillimetre && mirrored_rms(markers.image, markers.robot) < kClearly * rms;
}

}  // namespace

Expected<Registration> Rigid::find(const MarkerPairs& markers) const {
  if (auto wrong = invalid_input(markers, 3)) return refuse(std::move(*wrong));
  if (is_mirrored(markers)) {
    return refuse(
        "the robot's markers are the mirror image of the image's: is an axis of the "
        "images turned round?");
  }
  Registration found;
  found.used.assign(markers.image.size(), true);
  if (parameters_.outlier > 0) {
    auto used = agreeing_markers(markers, parameters_.outlier);
    if (!used) return tl::unexpected{used.error()};
    found.used = std::move(*used);
  }
  const MarkerPairs agreeing = only(markers, found.used);
  found.condition = condition_of_line(agreeing.image);
  if (!(found.condition <= parameters_.max_condition)) {
    return refuse(
        fmt::format("the markers lie nearly on one line: condition {:.4g}, at most {:g} "
                    "(max_condition)",
                    found.condition, parameters_.max_condition));
  }
  found.robot_T_image = rigid_fit(agreeing.image, agreeing.robot);
  measure_residuals(markers, found);
  return found;
}

}  // namespace armature::registration::rigid

ARMATURE_PLUGIN(armature::registration::rigid::Rigid);
