// SPDX-License-Identifier: Apache-2.0
#include "bottom_watch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

namespace armature::task::implant {

BottomWatch::BottomWatch(const GuidedChain& chain,
                         const std::vector<Eigen::Isometry3d>& image_T_sites)
    : flange_tip_{chain.flange_T_tool().translation()} {
  for (const Eigen::Isometry3d& site : image_T_sites) {
    bottoms_.push_back(
        {chain.base_T_site(site).translation(), std::numeric_limits<double>::infinity()});
  }
}

void BottomWatch::see(const Eigen::Isometry3d& base_T_flange) {
  const Eigen::Vector3d tip = base_T_flange * flange_tip_;
  for (Bottom& bottom : bottoms_) {
    bottom.min_distance_m = std::min(bottom.min_distance_m, (tip - bottom.point).norm());
  }
}

std::optional<std::string> BottomWatch::missed(std::size_t sites, double max_m) const {
  const auto last = bottoms_.begin() + static_cast<std::ptrdiff_t>(sites);
  const auto worst = std::ranges::max_element(bottoms_.begin(), last, {}, &Bottom::min_distance_m);
  if (worst == last || worst->min_distance_m <= max_m) return std::nullopt;
  return fmt::format(
      "the drill came no nearer than {:.2f} mm to the bottom of site {}, {:g} mm are allowed",
      1e3 * worst->min_distance_m, worst - bottoms_.begin() + 1, 1e3 * max_m);
}

}  // namespace armature::task::implant
